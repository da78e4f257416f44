"""Reads and writes the files of a run folder: data set, checkpoint, versions, summary."""
