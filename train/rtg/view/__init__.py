"""The live view of a run in a browser, with Rerun (the extra `view`)."""
