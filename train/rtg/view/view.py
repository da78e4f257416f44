"""`rtg view`: shows a run in the browser, or writes what would be shown to a file."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import subprocess
import tempfile
import time
import webbrowser
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from rtg.errors import RunError, StoppedError, UserError, in_words
from rtg.files import whole_files
from rtg.processes.children import Node, stop_all
from rtg.processes.interrupts import Interrupts
from rtg.view import web_page
from rtg.view.session import Session

_POLL = 0.1  # [s]
_PATIENCE = 30.0  # [s] until the viewer must listen

Say = Callable[[str], None]


def _program() -> Path:
    """Returns the path of Rerun's own program. Raises RunError if the package lacks it."""
    spec = importlib.util.find_spec("rerun_cli")
    path = Path("rerun") if spec is None or spec.origin is None else Path(spec.origin).parent
    if not (path / "rerun").is_file():
        raise RunError("the package rerun-sdk lacks its program rerun; legal: a wheel for Linux")
    return path / "rerun"


def _without_analytics(settings: Path) -> list[str]:
    """Returns the words that start a program with its settings in a folder, analytics disabled.

    Rerun's program would otherwise report its use. The settings of the user stay as they are.
    """
    words = ["env", f"XDG_CONFIG_HOME={settings}", f"XDG_DATA_HOME={settings}"]
    command = [*words, str(_program()), "analytics", "disable"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RunError(f"rerun analytics disable failed:\n{done.stdout}{done.stderr}")
    return words


@contextlib.contextmanager
def _viewer(data_port: int, asset_port: int) -> Iterator[Node]:
    """Starts Rerun's program, which holds the data and the files of the page."""
    with tempfile.TemporaryDirectory(prefix="rtg-view-") as settings:
        command = web_page.command(_program(), data_port, asset_port)
        words = [*_without_analytics(Path(settings)), *command]
        node = Node("rerun", words, Path(settings) / "rerun.log")
        try:
            yield node
        finally:
            stop_all([node])


def _wait_for(node: Node, ports: Sequence[int], stopped: Callable[[], bool]) -> None:
    """Waits until the viewer listens on all ports. Raises RunError if it does not."""
    deadline = time.monotonic() + _PATIENCE
    while not all(map(web_page.is_open, ports)):
        if stopped():
            raise StoppedError
        if node.exit_status() is not None or time.monotonic() > deadline:
            raise RunError(f"{node.name} does not listen:\n{node.log_tail()}")
        time.sleep(_POLL)


def serve(folder: Path, port: int, browser: bool, say: Say) -> None:
    """Shows a run on a page at `port` of this machine until a signal ends it.

    The data take the port `port` + 1. Opens the page in the user's browser if `browser`. Raises
    UserError for bad input, RunError if the viewer ends or does not come up.
    """
    data_port, asset_port = port + 1, web_page.free_port()
    for taken in (port, data_port):
        web_page.check_port(taken)
    session = Session(folder, say)
    with (
        contextlib.suppress(StoppedError),
        Interrupts() as interrupts,
        _viewer(data_port, asset_port) as node,
        web_page.WebPage(port, data_port, asset_port) as page,
        contextlib.closing(session),
    ):
        _wait_for(node, (data_port, asset_port), interrupts.requested)
        session.recording.connect_grpc(web_page.data_address(data_port))
        say(f"{page.address} shows {folder}, with the data on port {data_port}")
        say("for this machine alone; Ctrl-C ends it")
        session.begin(follow=not session.is_over())
        if browser:
            webbrowser.open(page.address)
        while not interrupts.requested():
            if node.exit_status() is not None:
                raise RunError(f"{node.exit_text()}:\n{node.log_tail()}")
            session.step()
            time.sleep(_POLL)


@contextlib.contextmanager
def _draft(file: Path) -> Iterator[Path]:
    """Yields the path of a recording that takes the place of `file` after the `with` block.

    Raises RunError if Rerun fails to write it.
    """
    draft = file.parent / f".{file.name}.{os.getpid()}"
    try:
        yield draft
        draft.replace(file)
    except RuntimeError as error:  # Rerun keeps the cause to itself, but it meets us as well
        try:
            whole_files.grow(draft)
        except OSError as cause:
            raise in_words(cause, file) from None
        raise RunError(f"--save {file}: {error}") from None
    finally:
        with contextlib.suppress(OSError):
            draft.unlink()


def _check_target(file: Path, draft: Path) -> None:
    """Raises UserError if a recording cannot be written to `draft` and renamed to `file`."""
    why = ""
    if file.is_dir():
        why = "is a folder; legal: FILE.rrd"
    elif file.suffix != ".rrd":
        why = "its name does not end in .rrd; legal: FILE.rrd"
    elif not file.parent.is_dir():
        why = f"there is no folder {file.parent}; legal: FILE.rrd in a folder that exists"
    if not why:
        try:
            draft.open("wb").close()
        except OSError as error:
            why = f"cannot be written: {error.strerror}; legal: a file that can be written"
    if why:
        raise UserError(f"--save {file}: {why}")


def save(folder: Path, file: Path, say: Say) -> None:
    """Writes what serve() would show to a recording, which `rerun FILE.rrd` opens.

    If a process works on the run, follows it to its end, or until a signal. Says so if the run was
    not finished. Raises UserError for bad input, RunError if the recording cannot be written whole.
    """
    with (
        _draft(file) as draft,
        contextlib.closing(Session(folder, say)) as session,
        Interrupts() as interrupts,
    ):
        _check_target(file, draft)
        session.recording.save(draft)
        follow = session.is_going_on()
        session.begin(follow=follow)
        while follow and session.is_going_on() and not interrupts.requested():
            session.step()
            time.sleep(_POLL)
        session.finish()
        if not session.is_over():
            say(f"{folder}: {session.state()}; this is what is there")
    say(f"recording: {file}")
