"""The plan of a run: resolved settings and a run folder, made before any process starts."""

from __future__ import annotations

import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rtg import _core, engines
from rtg.bus.bus import defect
from rtg.errors import UserError
from rtg.files import minari_data, own_data, run_folder, versions
from rtg.files.own_data import OwnData
from rtg.learn.settings import CHECKPOINT_SETTINGS
from rtg.run import effective_config, engine_time, shared_transitions
from rtg.run.run_args import Override, RunArgs


@dataclass(frozen=True)
class RunPlan:
    """The resolved settings of a run. Its folder holds config.yaml and versions.json."""

    folder: Path
    name: str  # unique name of the run on the bus
    config: _core.Config
    train: bool
    resume: bool
    notes: tuple[str, ...]  # messages for the user
    sinks: tuple[str, ...] = ()  # of log_sinks.SINKS, for the rows of progress.csv

    @property
    def in_process(self) -> bool:
        """True if the search runs in this process, without LCM."""
        return self.config.run.in_process

    @property
    def transitions_file(self) -> Path:
        """The file of the transitions, written at the end of the generation."""
        return self.folder / "transitions.npz"

    @property
    def report_file(self) -> Path:
        """The file of the report that the generation writes."""
        return self.folder / "generation.json"

    @property
    def own_data(self) -> dict[str, Any] | None:
        """The origin of the data that the run was given, see own_data.of_run()."""
        return own_data.of_run(self.folder)

    @property
    def title(self) -> str:
        """The title for pictures and for the first line of output."""
        run = self.config.run
        own = self.own_data
        data = f"own data {own['name'] or ''}".rstrip() if own else self.config.search.generator
        data = f", {data}" if self.offline else ""
        return f"{self.config.task.name}, {run.method}{data}, seed {run.seed}"

    @property
    def offline(self) -> bool:
        """True if the run generates transitions, or is given some."""
        return self.config.train.offline

    @property
    def interactions(self) -> int:
        """The learner's budget of interactions; 0 without training."""
        return self.config.train.interactions if self.train else 0

    def is_generated(self) -> bool:
        """Returns whether an earlier process of this run has finished the generation.

        Own data need no generation.
        """
        return (self.resume or self.own_data is not None) and shared_transitions.is_generated(
            self.folder
        )


def _check_device(config: _core.Config) -> None:
    if config.train.device == "cuda":  # PyTorch takes seconds to answer
        from rtg.learn import device

        device.chosen("cuda")


def check(config: _core.Config, train: bool) -> None:
    """Raises UserError if the run needs a missing CUDA device or has nothing to do."""
    if train:
        _check_device(config)
    elif not config.train.offline:
        raise UserError(
            f"--no-train: leaves nothing to do, as run.method {config.run.method} generates no "
            "transitions (train.offline is false); legal: another method, or no --no-train"
        )


def _check_search(config: _core.Config, overrides: Sequence[Override], data: str | None) -> None:
    """Raises UserError if the user asks for transitions, but the run has no use for them."""
    chosen = [
        o.typed
        for o in overrides
        if o.setting.startswith("search.generator=") or o.typed.startswith("--transitions")
    ]
    if chosen and data is not None:
        raise UserError(
            f"{chosen[-1]}: has no effect, as the transitions are those of --data {data}; legal: "
            "one of the two"
        )
    wanted = [f"--data {data}: has no effect"] if data is not None else []
    wanted += [f"{typed}: has no effect" for typed in chosen]
    if wanted and not config.train.offline:
        raise UserError(
            f"{wanted[-1]}, as run.method {config.run.method} generates no transitions and learns "
            "from none (train.offline is false); legal: another method, or without it"
        )


def _read_own_data(word: str, task: _core.Task) -> OwnData:
    """Reads the transitions that the user has. Raises UserError."""
    file = own_data.file_of(Path(word))
    if file.is_file() or word.endswith(".npz"):
        return own_data.read(file, task)
    folder = minari_data.folder_of(word)
    if folder is None:
        wrong = "holds no transitions" if Path(word).exists() else "no such file or data set"
        raise UserError(
            f"--data {word}: {wrong}; legal: a .npz with states, actions and "
            "next_states, a run that has its transitions, or the id or folder of a Minari data set "
            "(docs/data.md)"
        )
    return minari_data.read(word, folder, task)


def _check_engine(own: OwnData, data: str | None, engine: str) -> None:
    """Raises UserError if own data are those of a run with another forward simulator."""
    other = own.origin.get(versions.ENGINE_KEY, engine)
    if other != engine:
        raise UserError(
            f"--data {data}: its transitions are of the forward simulator {other}, and this run's "
            f"is {engine}; legal: the same forward.engine, version and forward.friction, or arrays "
            "of one's own (docs/data.md)"
        )


def _fixed_values(config: _core.Config, has_checkpoint: bool) -> dict[str, Any]:
    """Returns, by "section.key", the values that must not change when the run is resumed.

    These determine the transitions. If there is a checkpoint, they also determine its learner.
    """
    found = shared_transitions.determining_values(config)
    if has_checkpoint:
        train = effective_config.values(config)["train"]
        found["run.method"] = config.run.method
        found.update({f"train.{name}": train[name] for name in CHECKPOINT_SETTINGS})
    return found


def _check_resumed(file: Path, config: _core.Config) -> None:
    """Raises UserError if `config` cannot continue the run whose configuration is `file`.

    It checks the learner even without training, because the new configuration replaces `file` and
    must fit the checkpoint.
    """
    has_checkpoint = run_folder.checkpoint_file(file.parent).exists()
    before = _fixed_values(effective_config.load_written(file), has_checkpoint)
    after = _fixed_values(config, has_checkpoint)
    for name in sorted({*before, *after}):
        old, new = before.get(name), after.get(name)
        if old != new:
            raise UserError(
                f"--resume: {name} must stay {effective_config.as_typed(old)} as in {file}; legal: "
                "changes of train and run, except run.seed and, with a checkpoint, run.method and "
                f"train.{{{','.join(CHECKPOINT_SETTINGS)}}}"
            )


def _check_stored(run: Path, config: _core.Config) -> None:
    """Raises UserError if the stored transitions of a run that is resumed are not as they were."""
    if not config.train.offline:
        return
    file = run / "transitions.npz"
    if shared_transitions.is_generated(run):
        versions.check_seal(file)
    elif own_data.of_run(run):
        raise UserError(
            f"--resume: {file} is missing or not whole, and was given by --data; legal: a new run "
            "with --data"
        )


def plan_of(folder: Path) -> RunPlan:
    """Returns the plan of the run in `folder`, to read its results. Raises UserError."""
    config = effective_config.load_written(folder / "config.yaml")
    trained = (folder / "training.json").is_file()
    return RunPlan(folder, folder.name, config, trained, True, ())


def make_plan(args: RunArgs) -> RunPlan:
    """Resolves the configuration and writes it to the run folder, which it creates.

    Plans the generation in this process if it needs multicast and that does not work. Raises
    UserError for bad input.
    """
    overrides = args.overrides
    config = effective_config.load(args.file, overrides)
    if args.resume:
        _check_resumed(args.file, config)
        _check_stored(args.file.parent, config)
    engine = engines.identity(config)  # fails here, before there is a folder
    if args.resume:
        versions.check_engine(args.file.parent, engine)
    check(config, args.train)
    _check_search(config, overrides, args.data)
    own = None if args.data is None else _read_own_data(args.data, config.task)
    if own is not None:
        _check_engine(own, args.data, engine)
    notes = []
    if not args.resume:
        transitions = config.search.transitions if config.train.offline and own is None else 0
        interactions = config.train.interactions if args.train else 0
        notes += engine_time.words(config, transitions, interactions)
    needs_bus = config.train.offline and not config.run.in_process and own is None
    if needs_bus and (why := defect(config.run.bus)):
        notes.append(f"no process graph: {why}")
        notes.append("going on as with --in-process, which gives the same transitions")
        overrides = (*overrides, Override("--in-process", "run.in_process=true"))
        if config.run.record:
            notes.append("lcm.log is not recorded: there are no messages")
            overrides = (*overrides, Override("--in-process", "run.record=false"))
        config = effective_config.load(args.file, overrides)
    folder = args.out or run_folder.default_path(config.task.name)
    with run_folder.write_errors_as_user_errors(folder):
        folder.mkdir(parents=True, exist_ok=True)
        if own is not None:  # before there is a run to go on with, which would generate its own
            own_data.store(folder, config, own, engine)
        name = f"{folder.name}-{secrets.token_hex(4)}"
        run_folder.write_run_name(folder, name)
        run_folder.write_config(folder / "config.yaml", config.yaml)
    plan = RunPlan(folder, name, config, args.train, args.resume, tuple(notes), args.sinks)
    if own is None:
        versions.write(folder, engine, versions.generator(folder) if plan.is_generated() else None)
    return plan
