"""The files that a run leaves in its folder: data set, checkpoint, versions, and how they are read
back."""
