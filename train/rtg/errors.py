"""Errors that end a command early. The docstring of each names the exit status that follows."""

from __future__ import annotations


class UserError(Exception):
    """Bad input: a flag, a file or a folder.

    The message names the input and the legal values. Exit status 2.
    """


class RunError(Exception):
    """The run failed. The message names the cause and where to look for details. Exit status 1."""


class StoppedError(Exception):
    """The user stopped the run. The command turns this error into a RunError: exit status 1."""
