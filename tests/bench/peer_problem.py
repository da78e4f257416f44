"""The reverse problem with CasADi, written from its formulas
(core/reverse/problem/reverse_problem.hpp, core/energy) and sharing no code with the solver."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Json = dict[str, Any]


def _mass(vertices: Floats, density: float) -> tuple[float, float]:
    """Mass and moment about the centroid, which is the origin."""
    ahead = np.roll(vertices, -1, axis=0)
    cross = vertices[:, 0] * ahead[:, 1] - ahead[:, 0] * vertices[:, 1]
    squares = (vertices**2 + vertices * ahead + ahead**2).sum(axis=1)
    return density * cross.sum() / 2.0, density * (cross * squares).sum() / 12.0


def _planes(vertices: Floats) -> tuple[Floats, Floats]:
    """Outward unit normals [N, 2] and offsets [N] of the edges."""
    edges = np.roll(vertices, -1, axis=0) - vertices
    normals = np.column_stack([edges[:, 1], -edges[:, 0]]) / np.hypot(*edges.T)[:, None]
    return normals, (normals * vertices).sum(axis=1)


@dataclass(frozen=True)
class Contact:
    """A vertex of `body` that may touch `other`."""

    body: int
    other: int
    vertex: Floats
    friction: float


def _contacts(bodies: list[Json]) -> list[Contact]:
    found = []
    for i, j in combinations(range(len(bodies)), 2):
        if bodies[i]["fixed"] and bodies[j]["fixed"]:
            continue
        friction = math.sqrt(bodies[i]["friction"] * bodies[j]["friction"])
        for body, other in ((i, j), (j, i)):
            for vertex in bodies[body]["vertices"]:
                found.append(Contact(body, other, np.array(vertex), friction))
    return found


class PeerProblem:
    """Unknowns x = (p_0 ... p_h, λ_0 ... λ_h, c_1 ... c_h), poses of the movable bodies only.

    With the plain barrier, as printed in the paper, forces are no unknowns but λ = μ̃/g; p_h is none
    where the final state is fixed.
    """

    def __init__(self, dump: Json) -> None:
        self.dump = dump
        self._physics, self._reverse = dump["physics"], dump["reverse"]
        self._bodies = dump["bodies"]
        self._steps = int(self._physics["sub_steps"])
        self._stride = dump["stride"] / self._steps
        self._unit = self._physics["damping"] / self._physics["time_step"] ** 2
        shapes = [np.array(body["vertices"]) for body in self._bodies]
        self._planes = [_planes(shape) for shape in shapes]
        self._mass = [
            _mass(shape, body["density"]) for shape, body in zip(shapes, self._bodies, strict=True)
        ]
        self._reach = float(np.hypot(*shapes[0].T).max())  # of the robot
        self._contacts = _contacts(self._bodies)
        self._dofs = 3 * sum(not body["fixed"] for body in self._bodies)
        self._end = np.array(dump["end"])
        self._start_spare = dump["start_spare"]
        self._build()

    def _build(self) -> None:
        levels = range(self._steps + 1)
        self._p = [ca.SX.sym(f"p{k}", self._dofs) for k in levels]
        self._c = [ca.SX.sym(f"c{k}", 3) for k in levels[1:]]
        points = [[self._point(c, self._full(p)) for c in self._contacts] for p in self._p]
        gaps = [
            [self._gap(c, x) for c, x in zip(self._contacts, level, strict=True)]
            for level in points
        ]
        forces = [] if self._plain else [ca.SX.sym(f"f{k}", len(self._contacts)) for k in levels]
        self._forces = forces or [[self._barrier / g for g in level] for level in gaps]
        poses = self._p[:-1] if self._fixed_end else self._p
        self.x = ca.vertcat(*poses, *forces, *self._c)
        self.objective = self._objective(gaps[0])
        self.residuals = [self._residual(k, gaps, points) for k in levels[1:]]
        self.complementarity = [self._complementarity(k, f, gaps[k]) for k, f in enumerate(forces)]
        self.gaps = ca.vertcat(*(g for level in gaps for g in level))
        if self._fixed_end:
            self._put_end()

    def _put_end(self) -> None:
        """Puts the final state in the place of p_h."""
        values = [self.objective, self.gaps, *self.residuals]
        end = ca.DM(self._end[: self._dofs])
        self.objective, self.gaps, *self.residuals = ca.substitute(
            values, [self._p[-1]], [ca.SX(end)]
        )

    @property
    def _barrier(self) -> float:
        return float(self._physics["barrier"] / self._unit)

    @property
    def _plain(self) -> bool:
        return bool(self._physics["plain_barrier"])

    @property
    def _fixed_end(self) -> bool:
        return bool(self._reverse["terminal_weight"] == 0.0)

    def _full(self, p: Any) -> Any:
        """Appends the poses of the fixed bodies."""
        return ca.vertcat(p, self._end[self._dofs :])

    def _point(self, c: Contact, p: Any) -> Any:
        """The contact's vertex in the frame of the other body."""
        i, j = 3 * c.body, 3 * c.other
        cos, sin = ca.cos(p[i + 2]), ca.sin(p[i + 2])
        x = cos * c.vertex[0] - sin * c.vertex[1] + p[i] - p[j]
        y = sin * c.vertex[0] + cos * c.vertex[1] + p[i + 1] - p[j + 1]
        cos, sin = ca.cos(p[j + 2]), ca.sin(p[j + 2])
        return ca.vertcat(cos * x + sin * y, cos * y - sin * x)

    def _weights(self, c: Contact, point: Any) -> tuple[Any, Any]:
        """exp(α(n·x - b) - top) per edge, and top."""
        normals, offsets = self._planes[c.other]
        heights = self._physics["sharpness"] * (ca.mtimes(ca.DM(normals), point) - offsets)
        top = ca.mmax(heights)
        return ca.exp(heights - top), top

    def _gap(self, c: Contact, point: Any) -> Any:
        weights, top = self._weights(c, point)
        distance = (top + ca.log(ca.sum1(weights))) / self._physics["sharpness"]
        return distance - self._physics["skin"]

    def _window(self, gap: Any) -> Any:
        return ca.fmax(0.0, 1.0 - gap / self._physics["range"]) ** 3

    def _complementarity(self, k: int, forces: Any, gaps: list[Any]) -> Any:
        """λ g - μ̃ w of all contacts; at the start λ (g + g_s) - μ̃ w."""
        spare = 0.0 if k else self._start_spare
        rows = (
            forces[n] * (g + spare) - self._barrier * self._window(g) for n, g in enumerate(gaps)
        )
        return ca.vertcat(*rows)

    def _slip_potential(self, c: Contact, now: Any, after: Any) -> Any:
        normals, _ = self._planes[c.other]
        weights, _ = self._weights(c, now)
        slope = ca.mtimes(ca.DM(normals.T), weights) / ca.sum1(weights)
        slip = -slope[1] * (after[0] - now[0]) + slope[0] * (after[1] - now[1])
        scale = self._physics["slip"]
        return ca.sqrt(slip**2 + scale**2) - scale

    def _residual(self, k: int, gaps: Any, points: Any) -> Any:
        """Φ_k, the gradient of Ψ with the forces in the place of the barrier's."""
        after, before = self._p[k], self._p[k - 1]
        energy = 0
        for body in range(self._dofs // 3):
            mass, moment = self._mass[body]
            way = after[3 * body : 3 * body + 3] - before[3 * body : 3 * body + 3]
            turn = 1 - ca.cos(way[2]) if self._physics["periodic_turns"] else way[2] ** 2 / 2
            energy += mass * ca.sumsqr(way[:2]) / 2 + moment * turn
        for n, c in enumerate(self._contacts):
            gap = gaps[k][n]
            energy -= self._barrier * ca.log(gap) if self._plain else self._forces[k][n] * gap
            slip = self._slip_potential(c, points[k - 1][n], points[k][n])
            energy += c.friction * self._forces[k - 1][n] * slip
        drag = self._mass[0][0] * self._stride
        force, torque = self._physics["force_factor"], self._physics["torque_factor"]
        bound = drag * np.array([force, force, torque * self._reach])
        energy -= ca.dot(ca.DM(bound) * ca.tanh(self._c[k - 1]), after[:3])
        return ca.gradient(energy, after)

    def _objective(self, first_gaps: list[Any]) -> Any:
        r, h = self._reverse, self._steps
        direction = np.array(self.dump["direction"])
        total = 0
        for body in range(self._dofs // 3):
            weight = r["robot_weight"] if body == 0 else r["object_weight"]
            moved = self._p[0][3 * body : 3 * body + 2] - self._end[3 * body : 3 * body + 2]
            total += weight * ca.dot(direction, moved)
        for gap in first_gaps:
            total += self._barrier * self._closed(gap)
        for c in self._c:
            total += r["control_weight"] * ca.sumsqr(c)
        for k, p in enumerate(self._p):
            off = p[:2] - (self._end[:2] - (h - k) * self._stride * direction)
            total += r["path_weight"] * ca.sumsqr(off)
            total += r["heading_weight"] * (p[2] - self._end[2]) ** 2
        for before, after in zip(self._p[:-1], self._p[1:], strict=True):
            total += sum(self._haste(body, after - before) for body in range(1, self._dofs // 3))
        miss = self._p[h] - self._end[: self._dofs]
        return total + r["terminal_weight"] * ca.sumsqr(miss) / 2

    def _closed(self, gap: Any) -> Any:
        """Barrier over its weight."""
        if self._plain:
            return -ca.log(gap)
        y = ca.fmin(1.0, gap / self._physics["range"])
        return -ca.log(y) - 3 * (1 - y) + 1.5 * (1 - y**2) - (1 - y**3) / 3

    def _haste(self, body: int, way: Any) -> Any:
        mass, moment = self._mass[body]
        x, y, turn = (way[3 * body + m] for m in range(3))
        squared = (x**2 + y**2 + moment / mass * turn**2) / (2 * self._stride**2)
        return self._reverse["speed_weight"] * squared**3

    def terminal_miss(self, x: Floats) -> float:
        """Largest distance of a movable body from its final position [m]."""
        if self._fixed_end:
            return 0.0
        level = x[self._steps * self._dofs :][: self._dofs]
        off = (level - self._end[: self._dofs]).reshape(-1, 3)
        return float(np.hypot(off[:, 0], off[:, 1]).max())

    def unknowns(self, iterate: Json) -> Floats:
        """x of an iterate as the solver dumps it."""
        poses = [level[: self._dofs] for level in iterate["p"]]
        forces = [] if self._plain else iterate["forces"]
        poses = poses[:-1] if self._fixed_end else poses
        return np.concatenate([*poses, *forces, *iterate["controls"][1:]])

    def start_state(self, x: Floats) -> Floats:
        """State of the whole scene [bodies, 3] before the push."""
        state = np.array(self.dump["state"]).reshape(-1, 3)
        for k, body in enumerate(self.dump["members"][: self._dofs // 3]):
            state[body] = x[3 * k : 3 * k + 3]
        return state
