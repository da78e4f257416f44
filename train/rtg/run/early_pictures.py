"""Tells of the generation, in pictures and words, while the run goes on in other processes."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from types import TracebackType
from typing import Self

from rtg.run.plan import RunPlan

_POLL = 0.2  # [s]


class EarlyPictures:
    """Draws the pictures of the generation on a thread, once the generation has ended.

    If something limits the generation, it says so by `note`, before the training that may be in
    vain. Importing matplotlib and drawing take more than a second. Learning need not wait for it.
    """

    def __init__(self, plan: RunPlan, note: Callable[[str], None]) -> None:
        self._plan, self._note = plan, note
        # The report of a generation that begins anew is removed and written again.
        self._is_stale = plan.report_file.exists() and not plan.is_generated()
        self._over = threading.Event()
        self._is_finished = False  # the run is, not stopped or failed
        self._warning: str | None = None  # that was noted
        self._pool = ThreadPoolExecutor(1)

    def __enter__(self) -> Self:
        self._drawn = self._pool.submit(self._draw)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._over.set()
        self._pool.shutdown()

    def finish(self) -> None:
        """Waits until the pictures are there; to be called when the run has ended."""
        self._is_finished = True
        self._over.set()
        self._drawn.result()

    def warn_again(self) -> None:
        """Says once more what limits the generation; to be called when the user stops the run."""
        if self._warning:
            self._note(self._warning)

    def _draw(self) -> None:
        while self._is_stale or not self._plan.report_file.exists():
            if self._over.wait(_POLL):
                break
        if self._plan.report_file.exists() and (self._is_finished or not self._is_stale):
            from rtg.run import results  # imports matplotlib

            if self._plan.train and (words := results.generation_warning(self._plan)):
                self._note(words)
                self._warning = words
            results.draw_generation(self._plan)
