"""Runs jobs as child processes on this machine."""

from __future__ import annotations

from rtg.compare.jobs import Claim, Job, try_claim
from rtg.processes.children import Node


class _ClaimedNode(Node):
    """The process of a job. It holds the claim, too, should this process be killed before it."""

    def __init__(self, job: Job, claim: Claim) -> None:
        super().__init__(job.name, job.command(), job.log, claim.descriptors)
        self._claim = claim

    def exit_status(self) -> int | None:
        self._claim.share_transitions()
        return super().exit_status()

    def close(self) -> None:
        self._claim.close()


class LocalExecutor:
    """Starts a process for each job. Main thread only, see Node."""

    def start(self, job: Job) -> _ClaimedNode | None:
        job.log.parent.mkdir(parents=True, exist_ok=True)
        claim = try_claim(job)
        if claim is None:
            return None
        try:
            if not job.done:
                return _ClaimedNode(job, claim)
        except BaseException:
            claim.close()
            raise
        claim.close()
        return None
