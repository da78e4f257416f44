"""The step energy, whose minimum is the motion of all bodies in one sub-step of a push."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rtg import _core
from rtg.arguments import checked, numbers
from rtg.task import Task

Floats = NDArray[np.float64]


class Contact(NamedTuple):
    """A vertex of `body` that may touch `other`, or a limit of the joint between them.

    `friction`: coefficient of the pair.
    """

    body: str
    other: str
    friction: float


class StepEnergy:
    """The step energy Ψ of a task without the robot's actuation [eq. (8)].

    Ψ(next; now) = I + I_D(next - now) + Σ b(g(next)) + Σ μ λ φ(u(next, now))

    is a function of the poses after a sub-step, with inertia I (only in dynamic mode, and from
    rest here), damping I_D, the barrier b of each gap g, and friction, which is lagged: the normal
    forces λ are those before the sub-step. Energies are in units of damping over Δt², kg m².

    States are one each, [bodies, 3] in m and rad. Derivatives are with respect to the poses of the
    movable bodies, [3 movable]; with joints, to the coordinates that remain: of a body that hangs
    on a joint the third entry belongs to its angle (revolute) or the first to its slide
    (prismatic), and the others are 0. Raises ValueError for wrong shapes.
    """

    @checked
    def __init__(self, task: Task) -> None:
        self.task = task
        self._core = _core.StepEnergy(task.config)
        metre, kilogram = task.core.metre, task.core.kilogram
        self._energy = kilogram * metre**2  # 1 kg m² in the units of the core
        self._force = kilogram * metre
        self._metre = metre

    @property
    def contacts(self) -> list[Contact]:
        """All pairs of a vertex and a body that may touch, and the limits of joints. [C]"""
        names = self.task.bodies
        return [Contact(names[i], names[j], mu) for i, j, mu in self._core.contacts]

    def gaps(self, state: ArrayLike) -> Floats:
        """Returns the gap of each contact, [C] in m; twice the barrier's range if it is larger."""
        gaps: Floats = self._core.gaps(self._inner(state, "state")) / self._metre
        return gaps

    def forces(self, state: ArrayLike) -> Floats:
        """Returns the normal force -b' of each contact, [C] in N times Δt² over damping: kg m."""
        forces: Floats = self._core.forces(self._inner(state, "state")) / self._force
        return forces

    def value(self, after: ArrayLike, now: ArrayLike, forces: ArrayLike | None = None) -> float:
        """Returns Ψ at `after` for a sub-step from `now`; infinity where a gap is not positive.

        `forces`: normal forces [C] before the sub-step, those at `now` if None.
        """
        psi: float = self._core.value(*self._arguments(after, now, forces))
        return psi / self._energy

    def gradient(self, after: ArrayLike, now: ArrayLike, forces: ArrayLike | None = None) -> Floats:
        """Returns ∂Ψ/∂after, [3 movable] in kg m and kg m². Arguments are those of value()."""
        return self._model(after, now, forces)[0]

    def hessian(self, after: ArrayLike, now: ArrayLike, forces: ArrayLike | None = None) -> Floats:
        """Returns ∂²Ψ/∂after², [3 movable, 3 movable]. Arguments are those of value()."""
        return self._model(after, now, forces)[1]

    def _model(
        self, after: ArrayLike, now: ArrayLike, forces: ArrayLike | None
    ) -> tuple[Floats, Floats]:
        gradient, hessian = self._core.model(*self._arguments(after, now, forces))
        scale = np.tile([self._metre, self._metre, 1.0], len(gradient) // 3)
        return gradient * scale / self._energy, hessian * np.outer(scale, scale) / self._energy

    def _arguments(
        self, after: ArrayLike, now: ArrayLike, forces: ArrayLike | None
    ) -> tuple[Floats, Floats, Floats | None]:
        loads = None
        if forces is not None:
            loads = numbers("forces", forces, (len(self._core.contacts),)) * self._force
        return self._inner(after, "after"), self._inner(now, "now"), loads

    def _inner(self, state: ArrayLike, name: str) -> Floats:
        return self.task.inner_state(state, name)[None]
