"""The errors that end a command early, with its exit status."""

from __future__ import annotations


class UserError(Exception):
    """Bad input: a flag, a file, a folder. The message names it and says what is legal. Exit 2."""


class RunError(Exception):
    """The run itself failed; the message says what broke and where to look. Exit 1."""


class StoppedError(Exception):
    """The user asked for the end of the run. Exit 1."""
