"""Comparisons: runs of several methods, seeds and settings, and the report on them."""
