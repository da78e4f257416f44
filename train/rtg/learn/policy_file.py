"""The file of a trained policy: the weights of the value network, and their identity.

The identity holds the values of task and settings that determine the shapes of the weights, and a
hash of the task's content.
"""

from __future__ import annotations

import copy
import threading
from pathlib import Path
from typing import Any

import numpy as np
import torch as th
from numpy.typing import NDArray

from rtg import _core
from rtg.envs.layouts import Layouts
from rtg.errors import UserError
from rtg.files import checkpoint
from rtg.learn import networks
from rtg.learn.evaluation import Values
from rtg.learn.replay import unchanged
from rtg.learn.symmetry import Symmetry


def _interface(task: _core.Task) -> dict[str, Any]:
    """Returns what inputs and outputs of a network mean: units [m] and numbers of entries."""
    return {
        "position_unit": task.position_unit,
        "relative_unit": task.relative_unit,
        "observation_size": task.observation_size,
        "headings": task.headings,
        "strides": task.strides,
    }


def _contents(task: _core.Task) -> dict[str, Any]:
    return {**_interface(task), "task": task.content}


def identity(task: _core.Task, settings: _core.TrainConfig) -> dict[str, Any]:
    """Returns the values of task and settings that determine what the weights are of."""
    return {
        **_contents(task),
        "network": settings.network,
        "hindsight": settings.hindsight > 0,
        "symmetry": settings.symmetry,
    }


def check_identity(path: Path, found: Any, wanted: dict[str, Any]) -> None:
    """Raises UserError if a value of `wanted` differs in `found`, the identity in file `path`."""
    if not isinstance(found, dict):
        raise UserError(
            f"{path}: does not say with which settings it was made; legal: a file that RTG wrote"
        )
    for name, value in wanted.items():
        if found.get(name) != value and name == "task":
            raise UserError(
                f"{path}: was made for another task; legal: a file of one with the same bodies, "
                "joints, goal and pushes"
            )
        if found.get(name) != value:
            raise UserError(
                f"{path}: was made with {name} = {found.get(name)}, but this run has {value}; "
                "legal: the same value"
            )


def write(
    path: Path, task: _core.Task, settings: _core.TrainConfig, weights: dict[str, Any]
) -> None:
    """Writes the policy. `weights`: state_dict of the value network."""
    checkpoint.write(path, {"identity": identity(task, settings), "weights": weights})


def read(path: Path, task: _core.Task) -> Values:
    """Reads the values of a policy, [N, observation] -> [N, actions].

    Threads may share them; none waits for another. Raises UserError if the file does not fit the
    task.
    """
    state = checkpoint.read(path)
    found: Any = state.get("identity")
    weights = state.get("weights")
    check_identity(path, found, _contents(task))
    if found.get("network") not in list(networks.KINDS):
        raise UserError(f"{path}: has an unknown network; legal: {', '.join(networks.KINDS)}")
    if not isinstance(weights, dict):
        raise UserError(f"{path}: holds no policy; legal: a model.pt of RTG")
    layouts = Layouts(task) if found.get("hindsight") else None
    symmetry = Symmetry(task, layouts) if found.get("symmetry") else unchanged
    inputs = task.observation_size + (layouts.size if layouts else 0)
    network = networks.make(found["network"], inputs, task.headings, task.strides)
    try:
        network.load_state_dict(weights)
    except RuntimeError as error:
        raise UserError(
            f"{path}: its weights do not fit the network ({error}); legal: a model.pt of RTG"
        ) from error

    own = threading.local()  # networks have buffers, so each thread has its own network

    def values(observation: NDArray[np.float32]) -> NDArray[Any]:
        if observation.ndim != 2 or observation.shape[1] != task.observation_size:
            shape = list(observation.shape)
            raise ValueError(f"observations {shape}; legal: [N, {task.observation_size}]")
        seen = layouts.network_input_nearest(observation) if layouts else observation
        if not hasattr(own, "network"):
            own.network = copy.deepcopy(network)
            networks.flatten(own.network)
        with th.no_grad():
            q: NDArray[Any] = own.network(th.from_numpy(symmetry(seen))).numpy()
        return q

    return values
