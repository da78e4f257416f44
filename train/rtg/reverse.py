"""The reverse rigid-body simulator: from which states does a push lead to a given one?"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg import _core
from rtg.arguments import checked, indices
from rtg.files import own_data
from rtg.task import Task

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Contacts:
    """The contacts of N solves that exert forces, C in all. Friction is not told.

    Where corners of two bodies meet there are two, one of each body, whose forces add up.

    - `solve`: to which of the N solves each belongs. [C]
    - `sub_step`: at whose end it acts; 0: at the start of the push. [C]
    - `body`, `other`: on which the force acts, and which exerts it. [C]
    - `point`: [C, 2] in m.
    - `normal`: unit vectors from `other` to `body`. [C, 2]
    - `force`: normal forces. [C] in N
    """

    solve: Integers
    sub_step: Integers
    body: Integers
    other: Integers
    point: Floats
    normal: Floats
    force: Floats


@dataclass(frozen=True, repr=False)
class ReverseSolutions:
    """The results of N solves. NaN stands where a solve has no value.

    The SQP ends with a trajectory p_0 ... p_h of h sub-steps, the controls c_1 ... c_h of the
    robot, whose forces are shares tanh c of their bounds, and the contact forces. `starts` are the
    states to go on from: the beginning of the trajectory, and others from which the push meets the
    objects later.

    - `status`: "converged", "acceptable", "pruned", "infeasible", "iteration_limit",
      "line_search_failed", "singular" or "non_finite"; the first two have starts. [N]
    - `iterations`: of the SQP. [N]
    - `starts`: for each solve [up to 8, bodies, 3] in m and rad; empty without a solution.
    - `trajectory`: [N, h + 1, bodies, 3] in m and rad.
    - `controls`: force x, force y and torque of each sub-step, before tanh. [N, h, 3]
    - `objective`: J of eq. (6). [N] in kg m²
    - `infeasibility`: largest residual of the constraints, in the units of the core. [N]
    - `stationarity`: largest entry of the Lagrangian's gradient, in the same units. [N]
    - `contacts`: those that exert forces, see rtg.Contacts.
    """

    status: list[str]
    iterations: Integers
    starts: list[Floats]
    trajectory: Floats
    controls: Floats
    objective: Floats
    infeasibility: Floats
    stationarity: Floats
    contacts: Contacts

    def __repr__(self) -> str:
        counts = ", ".join(f"{n} {status}" for status, n in Counter(self.status).items())
        return f"ReverseSolutions of {len(self.status)} pushes: {counts}"

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Returns which solves have starts. [N]"""
        return np.array([len(starts) > 0 for starts in self.starts], np.bool_)


class ReverseSimulator:
    """Finds the states from which pushes lead to given states [eq. (6), (7)]."""

    @checked
    def __init__(self, task: Task) -> None:
        self.task = task
        self._core = _core.ReverseSimulator(task.config)

    @checked
    def solve(self, end_poses: ArrayLike, actions: ArrayLike, threads: int = 1) -> ReverseSolutions:
        """Solves N problems together, several per register: much faster than one by one.

        end_poses [N, bodies, 3] or one state for all, [bodies, 3]; actions [N]. The results do not
        depend on what is solved together, nor on `threads`. Raises ValueError for wrong shapes.
        """
        pushes = indices("action", actions, self.task.actions)
        if np.ndim(end_poses) == 2:
            ends = self.task.inner_state(end_poses, "end_poses")[None].repeat(len(pushes), axis=0)
        else:
            ends = own_data.in_task_units(self.task.core, end_poses, "end_poses")
        found = self._core.solve(ends, pushes, threads)
        objective, infeasibility, stationarity = found["figures"].T
        return ReverseSolutions(
            status=[_core.SOLVE_STATUSES[k] for k in found["status"]],
            iterations=found["iterations"],
            starts=[
                starts[:count]
                for starts, count in zip(found["starts"], found["found"], strict=True)
            ],
            trajectory=found["trajectory"],
            controls=found["controls"],
            objective=objective,
            infeasibility=infeasibility,
            stationarity=stationarity,
            contacts=Contacts(**found["contacts"]),
        )
