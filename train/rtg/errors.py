"""Errors that end a command early. The docstring of each names the exit status that follows."""

from __future__ import annotations

import sys
from collections.abc import Callable

from rtg import _core


class UserError(Exception):
    """Bad input: a flag, a file or a folder.

    The message names the input and the legal values. Exit status 2.
    """


class RunError(Exception):
    """The run failed. The message names the cause and where to look for details. Exit status 1."""


class StoppedError(Exception):
    """The user stopped the run. The command turns this error into a RunError: exit status 1."""


def exit_status(program: str, command: Callable[[], int]) -> int:
    """Returns the exit status of `command`, or the one that follows from its error.

    Prints the error after the name of the program. ConfigError is bad input, too.
    """
    try:
        return command()
    except (UserError, _core.ConfigError) as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 2
    except RunError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
