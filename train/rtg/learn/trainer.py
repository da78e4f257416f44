"""The learner's process: the trainer of graph.sh, and of runs without LCM.

`python -m rtg.learn.trainer RUN_FOLDER... [--resume] [--no-stream] [--log NAMES]`
reads RUN_FOLDER/config.yaml and receives the transitions of the run while it learns. It writes
transitions.npz, progress.csv, training_state.json (for displays), checkpoint/, model.pt,
best_episode.npz and training.json to the same folder. With `train.learner: planning` it learns
nothing and writes no model.pt.

Several runs learn side by side, each on its own thread. Their results are bitwise equal to those of
separate runs. On SIGINT, SIGTERM or SIGHUP the process writes a checkpoint and exits with status
128 + signal number. A second SIGINT or SIGTERM ends it at once.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path

import torch as th

from rtg import _core
from rtg.bus.bus import open_bus, read_key
from rtg.bus.node_status import ENDED, NodeStatus
from rtg.bus.transition_stream import TransitionStream
from rtg.errors import UserError, exit_status
from rtg.files import run_folder
from rtg.files.dataset import Rows
from rtg.learn import log_sinks
from rtg.learn.offline_data import FileSource, NoSource, Source
from rtg.learn.planning import Planning
from rtg.learn.training import Training
from rtg.processes.interrupts import Interrupts

_WAKE = 0.2  # [s]


def _parse(argv: Sequence[str] | None) -> argparse.Namespace:
    summary = __doc__.split("\n")[0]
    parser = argparse.ArgumentParser("rtg.learn.trainer", description=summary, allow_abbrev=False)
    parser.add_argument("folders", type=Path, metavar="RUN_FOLDER", nargs="+")
    parser.add_argument("--resume", action="store_true", help="go on from the checkpoint, if any")
    parser.add_argument(
        "--no-stream", action="store_true", help="learn from RUN_FOLDER/transitions.npz"
    )
    parser.add_argument("--log", metavar="NAMES", type=log_sinks.parse, default=(), help="also to")
    args = parser.parse_args(argv)
    if len(args.folders) > 1 and not args.no_stream:
        parser.error("several RUN_FOLDERs have no stream of their own; legal: with --no-stream")
    return args


def _source(training: Training | Planning, args: argparse.Namespace) -> Source:
    if isinstance(training, Planning) or not training.settings.offline:
        return NoSource()
    if args.no_stream:
        return FileSource(training.folder / "transitions.npz", training.task, training.data)
    key = read_key(training.folder / run_folder.KEY_FILE)
    bus = open_bus(training.config.run.bus, key)
    training.publish_status = NodeStatus(bus, "trainer").tick
    task = training.task
    if bus.warning:
        print(bus.warning, file=sys.stderr)
    _say(f"waits for the transitions of run {key.name}")
    begun = False

    def add(rows: Rows) -> None:
        nonlocal begun
        if not begun:
            _say("has the first transitions")
        begun = True
        training.data.add(rows)

    most = training.config.search.transitions
    return TransitionStream(bus, task.bodies, task.actions, most, add)


def _say(words: str) -> None:
    print(f"trainer: {words}", flush=True)


def _begin(folder: Path, args: argparse.Namespace) -> Training | Planning:
    config = _core.Config.from_file(folder / "config.yaml")
    training = (Planning if config.train.learner == "planning" else Training)(config, folder)
    training.runs = len(args.folders)
    training.log.sinks = log_sinks.LazySinks(args.log, folder, config)
    if training.has_checkpoint():
        if not args.resume:
            raise UserError(
                f"{folder}: holds a learner already (checkpoint/); legal: --resume, another folder"
            )
        training.restore()
    return training


def _learn(training: Training | Planning, args: argparse.Namespace, interrupts: Interrupts) -> int:
    """Performs one training run; returns the exit status. Raises UserError or RunError."""
    with contextlib.closing(_source(training, args)) as source:
        try:
            if not training.run(source, interrupts.requested, record=not args.no_stream):
                return 128 + interrupts.number
            training.finish()
        finally:
            if training.log.sinks:
                training.log.sinks.close()
            _say(f"ends after {training.scheduled_interactions:,} interactions")
            training.publish_status(ENDED, training.scheduled_interactions)
    return 0


def train(args: argparse.Namespace, interrupts: Interrupts) -> int:
    """Performs all training runs side by side; returns their highest exit status.

    Raises UserError or RunError after all runs have ended, that of the first folder that failed.
    """
    # Sequentially, because the initial weights come from the random generator of the process.
    trainings = [_begin(folder, args) for folder in args.folders]
    with ThreadPoolExecutor(len(trainings), initializer=_keep_to_one_thread) as pool:
        ends = [pool.submit(_learn, training, args, interrupts) for training in trainings]
        # Python handles signals in the main thread; one that another thread gets does not wake it.
        while wait(ends, _WAKE).not_done:
            pass
    return max(end.result() for end in ends)


def _keep_to_one_thread() -> None:
    """Limits PyTorch to one thread.

    Networks this small are slower on more threads, up to a hundred times on a busy machine.
    """
    th.set_num_threads(1)


def main(argv: Sequence[str] | None = None) -> int:
    _keep_to_one_thread()
    with Interrupts() as interrupts:
        return exit_status("rtg.learn.trainer", lambda: train(_parse(argv), interrupts))


if __name__ == "__main__":
    sys.exit(main())
