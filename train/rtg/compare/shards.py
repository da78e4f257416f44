"""Generations in shards: jobs that find parts of one data set, and a job that merges them.

What a shard finds depends on its number alone (search.shards, search.shard). So the data are the
same to the bit wherever the jobs run, and as one process would find them.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rtg import _core
from rtg.compare.cell_run import CellRun, module_command
from rtg.compare.grouped_seeds import Generation
from rtg.compare.merged_report import merged
from rtg.errors import exit_status
from rtg.files import dataset, row_digest, run_folder, versions
from rtg.files.dataset import Rows
from rtg.files.recorder import Recorder
from rtg.run import effective_config, run_args


@dataclass(frozen=True)
class Shard(Generation):
    """The job that finds one shard. Its `run` is a run of its own, which does not train."""

    @property
    def name(self) -> str:
        return f"{self.run.name}: shard {self.run.folder.name}"


@dataclass(frozen=True)
class Merge(Generation):
    """The job that makes one data set of shards, for a run."""

    shards: tuple[Shard, ...]

    def command(self) -> list[str]:
        if not self.run.begun:
            self.run.begin()
        folders = [str(shard.run.folder) for shard in self.shards]
        return module_command("rtg.compare.shards", str(self.run.folder), *folders)

    def outcome(self) -> str:
        return "merged"


def stages(runs: Sequence[CellRun]) -> tuple[list[Shard], list[Merge]]:
    """Returns the jobs to do before `runs`: all shards, then their merges.

    Runs that share a generation share its shards; the first of them merges these, and the others
    take the data over.
    """
    found: dict[str, Merge] = {}
    for run in runs:
        key = run.pending_generation_key
        if key and key not in found and (shards := _shards(run, key)):
            found[key] = Merge(run, shards)
    merges = list(found.values())
    return [shard for merge in merges for shard in merge.shards], merges


def _shards(run: CellRun, key: str) -> tuple[Shard, ...]:
    """Returns the shards of the generation of a run; none if it is not divided."""
    args = run_args.parse(run.arguments)
    search = effective_config.load(args.file, args.overrides).search
    if search.shards == 1:
        return ()
    digest = hashlib.sha256((key + versions.core_digest()).encode()).hexdigest()[:16]
    folder = run.folder.parents[1] / ".shards" / digest
    return tuple(Shard(_run_of_shard(run, folder, search, k)) for k in range(search.shards))


def _run_of_shard(run: CellRun, folder: Path, search: _core.SearchConfig, k: int) -> CellRun:
    transitions = _core.share_of_shard(search, k)
    settings = ("shards=1", f"shard={search.shard + k}", f"transitions={transitions}")
    words = [word for setting in settings for word in ("--set", f"search.{setting}")]
    return replace(
        run, folder=folder / f"{k}", arguments=(*run.arguments, *words), generation_key=None
    )


def merge(run: Path, shards: Sequence[Path]) -> None:
    """Makes the transitions of the shards those of the run, in their order.

    Raises UserError if files of the shards are missing or damaged.
    """
    config = _core.Config.from_file(run / "config.yaml")
    versions.write(run, versions.engine_of_data(shards[0]))
    recorder = Recorder(config)
    for shard in shards:
        found = dataset.read(shard / "transitions.npz", config.task)
        recorder.add(Rows._make(getattr(found, name) for name in Rows._fields))
    report = merged([run_folder.read_json(shard / "generation.json") for shard in shards])
    report[row_digest.KEY] = recorder.digest()
    run_folder.write_json(run / "generation.json", report, indent=None)
    recorder.finish(run / "transitions.npz")


def main(words: Sequence[str]) -> int:
    run, *shards = map(Path, words)
    merge(run, shards)
    return 0


if __name__ == "__main__":
    sys.exit(exit_status("rtg.compare.shards", lambda: main(sys.argv[1:])))
