"""What one run is going to do, resolved and written down before anything starts."""

from __future__ import annotations

import json
import secrets
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rtg.bus import multicast
from rtg.errors import UserError
from rtg.files import run_folder, versions
from rtg.learn.settings import OF_CHECKPOINT
from rtg.run import effective_config, shared_transitions
from rtg.run.run_args import Override, RunArgs

_IMITABLE = ("rrbs", "naive", "forward")  # generators of steps that were found to lead on


@dataclass(frozen=True)
class RunPlan:
    """A run whose folder, with config.yaml and versions.json in it, exists."""

    folder: Path
    name: str  # of the run on the bus; no two runs share it
    config: dict[str, Any]  # as the C++ loader resolved it
    train: bool
    resume: bool
    notes: tuple[str, ...]  # for the user

    @property
    def in_process(self) -> bool:
        """The search in this process, no LCM."""
        return bool(self.config["run"]["in_process"])

    @property
    def config_file(self) -> Path:
        """The canonical configuration."""
        return self.folder / "config.yaml"

    @property
    def transitions_file(self) -> Path:
        """Written at the end of the generation."""
        return self.folder / "transitions.npz"

    @property
    def report_file(self) -> Path:
        """What the generation says of itself."""
        return self.folder / "generation.json"

    @property
    def title(self) -> str:
        """For pictures and first words."""
        run = self.config["run"]
        generator = f", {self.config['search']['generator']}" if self.offline else ""
        return f"{self.config['task']['name']}, {run['method']}{generator}, seed {run['seed']}"

    @property
    def offline(self) -> bool:
        """Whether transitions are generated."""
        return bool(self.config["train"]["offline"])

    @property
    def interactions(self) -> int:
        """Budget of the learner; 0 without training."""
        return int(self.config["train"]["interactions"]) if self.train else 0

    def is_generated(self) -> bool:
        """Whether an earlier process of this run has done the generation."""
        return self.resume and shared_transitions.are_there(self.folder)


def _check_offline(config: dict[str, Any], train: bool) -> None:
    """Raises UserError for what makes no sense without generated transitions."""
    if config["train"]["offline"]:
        return
    method = config["run"]["method"]
    if not train:
        raise UserError(
            f"--no-train: nothing to do, run.method {method} generates no transitions "
            "(train.offline is false); legal: another method, or with training"
        )
    if config["run"]["record"]:
        raise UserError("run.record: without train.offline there are no messages; legal: false")


def _check_learner(config: dict[str, Any]) -> None:
    """Raises UserError for a learner without what it learns from, or with what it cannot use."""
    train, generator = config["train"], config["search"]["generator"]
    learner, interacts, offline = train["learner"], train["interact"], train["offline"]
    if learner == "planning":
        if interacts or offline:
            raise UserError(
                "train.learner: planning learns from nothing; legal: with train.interact and "
                "train.offline false"
            )
    elif not interacts and not offline:
        raise UserError(
            "train.interact: false without train.offline leaves nothing to learn from; legal: "
            "either true, or train.learner planning"
        )
    elif learner == "cloning" and (interacts or generator not in _IMITABLE):
        raise UserError(
            "train.learner: cloning imitates generated steps alone; legal: with train.interact "
            f"false and search.generator one of {', '.join(_IMITABLE)}"
        )


def _check_device(config: dict[str, Any]) -> None:
    if config["train"]["device"] == "cuda":  # PyTorch takes seconds to answer
        from rtg.learn import device

        device.chosen("cuda")


def _check_buffer(config: dict[str, Any]) -> None:
    transitions, buffer = config["search"]["transitions"], config["train"]["buffer"]
    if config["train"]["offline"] and buffer < transitions:
        raise UserError(
            f"train.buffer: {buffer} is too small for search.transitions = {transitions}; legal "
            "are equal or larger ones, or --no-train"
        )


def check(config: dict[str, Any], train: bool) -> None:
    """Raises UserError for what the loader takes and no run can do."""
    _check_offline(config, train)
    if train:
        _check_learner(config)
        _check_buffer(config)
        _check_device(config)
    if config["run"]["in_process"] and config["run"]["record"]:
        raise UserError("run.record: with run.in_process there are no messages; legal: false")


def _fixed_values(config: dict[str, Any], has_checkpoint: bool) -> dict[str, Any]:
    """What a run keeps for good, by dotted name: what decides the transitions, and what a
    checkpoint is bound to once there is one."""
    found: dict[str, Any] = {"run.seed": config["run"]["seed"]}
    for section in ("task", "physics", "reverse", "search"):
        found.update({f"{section}.{name}": value for name, value in config[section].items()})
    if has_checkpoint:
        found["run.method"] = config["run"]["method"]
        found.update({f"train.{name}": config["train"][name] for name in OF_CHECKPOINT})
    return found


def _check_resumed(file: Path, config: dict[str, Any]) -> None:
    """Raises UserError if `config` does not go on with the run whose configuration is `file`.

    Also without training: the configuration in the folder stays the one of its checkpoint.
    """
    effective_config.check_version(file)
    has_checkpoint = run_folder.checkpoint_file(file.parent).exists()
    before = _fixed_values(effective_config.values(file), has_checkpoint)
    after = _fixed_values(config, has_checkpoint)
    for name in sorted({*before, *after}):
        old, new = before.get(name), after.get(name)
        if old != new:
            kept = old if isinstance(old, str) else json.dumps(old)
            raise UserError(
                f"--resume: {name} must stay {kept} as in {file}; legal are changes of train and "
                "run, but for run.seed and, with a checkpoint, run.method and "
                f"train.{{{','.join(OF_CHECKPOINT)}}}"
            )


def make_plan(args: RunArgs) -> RunPlan:
    """Resolves the configuration and makes the run folder. Raises UserError."""
    overrides = args.overrides
    config = effective_config.values(args.file, overrides)
    if args.resume:
        _check_resumed(args.file, config)
    check(config, args.train)
    notes = []
    needs_bus = config["train"]["offline"] and not config["run"]["in_process"]
    if needs_bus and (why := multicast.defect(config["run"]["bus"])):
        notes.append(f"no process graph: {why}")
        notes.append("going on as with --in-process, which gives the same transitions")
        overrides = (*overrides, Override("--in-process", "run.in_process=true"))
        if config["run"]["record"]:
            notes.append("lcm.log is not recorded: there are no messages")
            overrides = (*overrides, Override("--in-process", "run.record=false"))
        config = effective_config.values(args.file, overrides)
    canonical = effective_config.canonical(args.file, overrides)
    folder = args.out or run_folder.default_path(config["task"]["name"])
    with run_folder.writing_to(folder):
        folder.mkdir(parents=True, exist_ok=True)
        run_folder.write_text(folder / "config.yaml", canonical)
    name = f"{folder.name}-{secrets.token_hex(4)}"
    plan = RunPlan(folder, name, config, args.train, args.resume, tuple(notes))
    versions.note(folder, versions.generator(folder) if plan.is_generated() else None)
    return plan
