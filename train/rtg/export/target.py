"""The folder that an export writes, which no other one may write meanwhile."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path

from rtg.errors import UserError
from rtg.files import locks
from rtg.files.run_folder import write_errors_as_user_errors


@contextlib.contextmanager
def held(folder: Path) -> Iterator[None]:
    """Keeps other exports away from `folder`, which need not exist, in the `with` block.

    Raises UserError if another one has it, and for what cannot be written in the block. The lock is
    the file .NAME.lock beside the folder, which the kernel frees if the process is killed.
    """
    with write_errors_as_user_errors(folder):
        folder.parent.mkdir(parents=True, exist_ok=True)
        lock = locks.try_lock(folder.with_name(f".{folder.name}.lock"))
        if lock is None:
            raise UserError(
                f"--out: {folder}: another export writes it; legal: another folder, or wait"
            )
        try:
            yield
        finally:
            lock.release()


@contextlib.contextmanager
def draft(folder: Path) -> Iterator[Path]:
    """Yields the path .NAME.part beside `folder`, for what is to be renamed when it is whole.

    Removes what an export that was killed has left there, and what the `with` block leaves.
    """
    path = folder.with_name(f".{folder.name}.part")
    if path.exists():
        shutil.rmtree(path)
    try:
        yield path
    finally:
        shutil.rmtree(path, ignore_errors=True)
