"""What an engine simulates: bodies, joints and the pushes of the robot, in metres, kg and s."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rtg import _core

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Part:
    """A convex part of a body: all points within `radius` of a convex polygon.

    A disc is a polygon of one vertex, a plain polygon has the radius 0.
    """

    vertices: Floats  # counterclockwise, in the frame of the body [n, 2]
    radius: float  # [m]


@dataclass(frozen=True)
class Body:
    """A rigid body, whose frame sits at its centre of mass."""

    name: str
    kind: str
    parts: list[Part]  # their union is the body; they may overlap
    mass: float  # [kg]
    moment: float  # of inertia about the centre of mass [kg m²]
    friction: float  # coefficient μ; a pair uses √(μ₁μ₂)
    fixed: bool  # never moves


@dataclass(frozen=True)
class Joint:
    """A joint of two bodies, which do not collide with each other.

    With a point of each it holds, at its value v,

        revolute:   the points coincide,                     v = θ_child - θ_parent [rad];
        prismatic:  child's = parent's + v · axis,           θ_child = θ_parent + angle, v [m];
        fixed:      the points coincide,                     θ_child = θ_parent + angle.
    """

    type: str  # "revolute", "prismatic" or "fixed"
    parent: int  # index of the body
    child: int
    on_parent: Floats  # the point, in the frame of the parent [2]
    on_child: Floats  # the point, in the frame of the child [2]
    axis: Floats  # unit vector, in the frame of the parent [2]
    angle: float  # [rad]
    lower: float  # limits of the value; infinite if there are none
    upper: float


class Scene:
    """The scene of a task. Body 0 is the robot."""

    def __init__(self, config: _core.Config) -> None:
        self._task = task = config.task
        bodies, joints = task.scene
        m, kg = task.metre, task.kilogram
        self.bodies = [
            Body(
                b.name,
                b.kind,
                [Part(vertices / m, radius / m) for vertices, radius in b.parts],
                b.mass / kg,
                b.moment / (kg * m * m),
                b.friction * config.forward.friction,
                b.fixed,
            )
            for b in bodies
        ]
        self.joints = []
        for j in joints:
            unit = m if j.type == "prismatic" else 1.0
            ends = (j.on_parent / m, j.on_child / m, j.axis, j.angle)
            self.joints.append(
                Joint(j.type, j.parent, j.child, *ends, j.lower / unit, j.upper / unit)
            )
        physics = config.physics
        # Rate at which friction with the table takes velocity away, by translation and turning.
        self.damping: float = physics.damping / physics.time_step  # [1/s]
        self.push_s: float = physics.sub_steps * physics.time_step  # time of a push [s]
        ways = task.ways(np.arange(task.actions))
        self.stride: float = float(np.linalg.norm(ways, axis=1).max()) / m  # longest push [m]
        self.force_factor: float = physics.force_factor  # largest force of the robot / own drag
        self.torque_factor: float = (
            physics.torque_factor
        )  # the same of its torque / (drag · radius)
        self.size: float = 0.8 / m  # radius of the robot, or task.scale [m]
        self.start: Floats = task.start / [m, m, 1.0]  # has the places of fixed bodies [bodies, 3]

    def is_free(self, states: Floats, ways: Floats) -> Bools:
        """Returns where the robot meets no body on its way. [N, bodies, 3], [N, 2] -> [N]

        On a way of 0 it meets none.
        """
        m, moves = self._task.metre, ways.any(1)
        free = np.ones(len(states), np.bool_)
        free[moves] = self._task.is_free(states[moves] * [m, m, 1.0], ways[moves] * m)
        return free
