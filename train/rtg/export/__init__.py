"""Writes the data of a run in formats of other libraries."""
