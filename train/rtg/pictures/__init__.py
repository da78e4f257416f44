"""Scenes and figures of a run, drawn."""
