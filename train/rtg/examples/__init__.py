"""Numbered examples: `python -m rtg.examples.01_reverse_pushes [FOLDER]`.

Each is a program of its own. It leaves a picture of its name in FOLDER, by default the current one.
"""
