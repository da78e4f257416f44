"""Training from transitions, and trained policies."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg import _core, engines
from rtg.arguments import checked, numbers
from rtg.errors import UserError
from rtg.files import own_data, run_folder
from rtg.files.own_data import OwnData
from rtg.files.row_digest import row_digest
from rtg.task import Task
from rtg.transitions import Transitions


class Policy:
    """The policy of a trained value network: it takes the action of the largest value."""

    @checked
    def __init__(self, task: Task, file: Path) -> None:
        """Reads `file`, a model.pt. Raises UserError if it does not fit the task."""
        from rtg.learn import policy_file  # imports PyTorch

        self.task = task
        self._values = policy_file.read(file, task.core)

    def values(self, states: ArrayLike) -> NDArray[np.float32]:
        """Returns Q of all actions in states. [N, bodies, 3] -> [N, actions]"""
        return self.values_of_observations(self.task.observation(states))

    def values_of_observations(self, observations: ArrayLike) -> NDArray[np.float32]:
        """The same for what a learner sees, as of a Gymnasium environment. [N, observation]"""
        seen = numbers("observations", observations, (None, self.task.core.observation_size))
        values: NDArray[np.float32] = self._values(seen.astype(np.float32))
        return values

    def __call__(self, states: ArrayLike) -> NDArray[np.int64]:
        """Returns the actions to take in states. [N, bodies, 3] -> [N]"""
        return self.values(states).argmax(axis=1)

    @checked
    def success_rate(self, episodes: int = 100) -> float:
        """Returns the share of held-out starts from which it succeeds within the horizon.

        In a state to which an episode returns, the best action not yet tried there is taken.
        """
        from rtg.learn.evaluation import evaluate, final_starts

        config = self.task.config_with([f"train.eval_episodes={episodes}"])
        starts = final_starts(config, episodes)
        found = evaluate(config, self._values, starts, config.learner_discount)
        return float(found.success.mean())


@checked
def load_policy(run: str | PathLike[str]) -> Policy:
    """Loads the policy of a run. `run`: its folder. Raises UserError if it has none."""
    file, model = run_folder.policy_files(Path(run))
    return Policy(Task(_core.Config.from_file(file, [])), model)


def _own_data(task: Task, data: Transitions) -> OwnData:
    """Returns the data for the learner. Raises ValueError for what is not legal."""
    rows = own_data.rows_in_metres(
        task.core, data.states, data.actions, data.next_states, data.source
    )
    return OwnData(rows, {"format": "arrays", "name": None, "sha256": row_digest(rows)})


@checked
def train(
    data: Transitions,
    task: Task,
    folder: str | PathLike[str],
    *,
    interactions: int | None = None,
    seed: int = 1,
    settings: Sequence[str] = (),
) -> Policy:
    """Trains a policy from transitions, and interactions with the task, and returns it.

    The folder becomes that of a run: with the policy, the course of training and the transitions.
    `interactions`: their largest number, `train.interactions` of the task if None. `settings`: each
    "section.key=value", such as "train.interact=false". Success is judged by the task, whatever the
    data say. Raises ValueError for data or settings that are not legal, UserError if there is a
    learner in the folder already.
    """
    import torch as th

    from rtg.learn.offline_data import FileSource
    from rtg.learn.training import Training

    own = [f"run.seed={seed}"]
    if interactions is not None:
        own.append(f"train.interactions={interactions}")
    config = task.config_with(own, settings)
    given = _own_data(task, data)
    run = Path(folder)
    if (run / "checkpoint").exists() or (run / "model.pt").exists():
        raise UserError(f"{run}: holds a learner already; legal: another folder")
    run.mkdir(parents=True, exist_ok=True)
    run_folder.write_config(run / "config.yaml", config.yaml)
    own_data.store(run, config, given, engines.identity(config))
    threads = th.get_num_threads()
    th.set_num_threads(1)  # networks this small are slower on more
    try:
        training = Training(config, run)
        source = FileSource(run / "transitions.npz", training.task, training.data)
        training.run(source, lambda: False, record=False)
        training.finish()
    finally:
        th.set_num_threads(threads)
    return load_policy(run)
