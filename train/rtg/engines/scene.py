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

    - `vertices`: counterclockwise, in the frame of the body. [n, 2] in m
    - `radius`: in m.
    """

    vertices: Floats
    radius: float


@dataclass(frozen=True)
class Body:
    """A rigid body, whose frame sits at its centre of mass.

    - `parts`: their union is the body; they may overlap.
    - `mass`: in kg.
    - `moment`: of inertia about the centre of mass, in kg m².
    - `friction`: coefficient μ; a pair uses √(μ₁μ₂).
    - `fixed`: whether it never moves.
    """

    name: str
    kind: str
    parts: list[Part]
    mass: float
    moment: float
    friction: float
    fixed: bool


@dataclass(frozen=True)
class Joint:
    """A joint of two bodies, which do not collide with each other.

    With a point of each it holds, at its value v,

        revolute:   the points coincide,                     v = θ_child - θ_parent [rad];
        prismatic:  child's = parent's + v · axis,           θ_child = θ_parent + angle, v [m];
        fixed:      the points coincide,                     θ_child = θ_parent + angle.

    - `type`: "revolute", "prismatic" or "fixed".
    - `parent`, `child`: indices of the bodies.
    - `on_parent`, `on_child`: the point of each, in its frame. [2] in m
    - `axis`: unit vector in the frame of the parent. [2]
    - `angle`: in rad.
    - `lower`, `upper`: limits of the value in m or rad; infinite if there are none.
    """

    type: str
    parent: int
    child: int
    on_parent: Floats
    on_child: Floats
    axis: Floats
    angle: float
    lower: float
    upper: float


class Scene:
    """The scene of a task. Body 0 is the robot.

    - `bodies`, `joints`: those of the task.
    - `damping`: rate at which friction with the table takes velocity away, of translation as of
      turning, in 1/s.
    - `push_s`: time of a push, in s.
    - `stride`: the longest push, in m.
    - `force_factor`: largest force of the robot by its own drag.
    - `torque_factor`: largest torque of the robot by its drag times its radius.
    - `size`: radius of the robot, or `task.scale`, in m.
    - `start`: has the places of fixed bodies. [bodies, 3] in m and rad
    """

    bodies: list[Body]
    joints: list[Joint]
    damping: float
    push_s: float
    stride: float
    force_factor: float
    torque_factor: float
    size: float
    start: Floats

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
        self.damping = physics.damping / physics.time_step
        self.push_s = physics.sub_steps * physics.time_step
        ways = task.ways(np.arange(task.actions))
        self.stride = float(np.linalg.norm(ways, axis=1).max()) / m
        self.force_factor = physics.force_factor
        self.torque_factor = physics.torque_factor
        self.size = 0.8 / m
        self.start = task.start / [m, m, 1.0]

    def is_free(self, states: Floats, ways: Floats) -> Bools:
        """Returns where the robot meets no body on its way. [N, bodies, 3], [N, 2] -> [N]

        On a way of 0 it meets none.
        """
        m, moves = self._task.metre, ways.any(1)
        free = np.ones(len(states), np.bool_)
        free[moves] = self._task.is_free(states[moves] * [m, m, 1.0], ways[moves] * m)
        return free
