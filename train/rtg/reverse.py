"""The reverse rigid-body simulator: from which states does a push lead to a given one?"""

from __future__ import annotations

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
    """The contacts of N solves that exert forces, C in all."""

    solve: Integers  # to which of the N solves each belongs [C]
    sub_step: Integers  # at whose end it acts; 0: at the start of the push [C]
    body: Integers  # on which the force acts [C]
    other: Integers  # which exerts it [C]
    point: Floats  # [C, 2] in m
    normal: Floats  # unit vectors from `other` to `body` [C, 2]
    force: Floats  # normal forces [C] in N


@dataclass(frozen=True)
class ReverseSolutions:
    """The results of N solves. NaN stands where a solve has no value.

    The SQP ends with a trajectory p_0 ... p_h of h sub-steps, the controls c_1 ... c_h of the
    robot, whose forces are shares tanh c of their bounds, and the contact forces. `starts` are the
    states to go on from: the beginning of the trajectory, and others from which the push meets the
    objects later.
    """

    status: list[str]  # "converged", "acceptable", "pruned", "infeasible", ... [N]
    iterations: Integers  # of the SQP [N]
    starts: list[Floats]  # per solve [up to 8, bodies, 3]; empty without a solution
    trajectory: Floats  # [N, h + 1, bodies, 3]
    controls: Floats  # force x, force y, torque, before tanh [N, h, 3]
    objective: Floats  # J of eq. (6) [N] in kg m²
    infeasibility: Floats  # largest residual of the constraints [N] in the units of the core
    stationarity: Floats  # largest entry of the Lagrangian's gradient [N], the same
    contacts: Contacts

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
        metre = self.task.core.metre
        kilogram = self.task.core.kilogram
        objective, infeasibility, stationarity = found["figures"].T
        contacts = found["contacts"]
        return ReverseSolutions(
            status=[_core.SOLVE_STATUSES[k] for k in found["status"]],
            iterations=found["iterations"],
            starts=[
                starts[:count]
                for starts, count in zip(
                    self.task.outer(found["starts"]), found["found"], strict=True
                )
            ],
            trajectory=self.task.outer(found["trajectory"]),
            controls=found["controls"],
            objective=objective / (kilogram * metre**2),
            infeasibility=infeasibility,
            stationarity=stationarity,
            contacts=Contacts(
                solve=contacts["solve"],
                sub_step=contacts["sub_step"],
                body=contacts["body"],
                other=contacts["other"],
                point=contacts["point"] / metre,
                normal=contacts["normal"],
                force=contacts["force"] / (kilogram * metre),
            ),
        )
