"""MuJoCo as a forward simulator: bodies extruded from the plane, with planar joints."""

from __future__ import annotations

import os
import threading
from xml.etree import ElementTree

import numpy as np

from rtg import extras
from rtg.engines.scene import Body, Bools, Floats, Joint, Scene

_STEPS = 250  # of a push
_LATE_STEPS = 10  # more, as contacts delay the robot
_REST_STEPS = 75  # afterwards, with the robot held where it is
_REST_ROLLS = 8  # so often, until all bodies are at rest: chains take long
_AT_REST = 0.01  # largest speed of a body that has come to rest [sizes of the robot / s], [rad/s]
# Lengths in sizes of the robot:
_SKIN = 0.025  # bodies in contact keep this far apart, as in Box2D
_LAG = 0.0125  # of the robot behind its way, while it moves freely
_ARC = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)  # a round corner is a polygon
_STILL = np.zeros(2)
_COLUMNS = ("x", "y", "theta", "value")  # names of MuJoCo's joints, after the number of the body
_VALUE = 3
_BATCH = 256  # pushes at a time, for the sake of memory
_POOL = threading.Lock()  # MuJoCo has one pool of threads in a process, for one caller at a time


def _turned(angle: Floats | float, v: Floats) -> Floats:
    """Returns vectors turned by angles. [...], [2] -> [..., 2]"""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * v[0] - s * v[1], s * v[0] + c * v[1]], -1)


def _words(*numbers: float) -> str:
    return " ".join(f"{number:.17g}" for number in numbers)


class _Model:
    """The scene in MJCF. Lengths are in sizes of the robot, masses in that of the robot.

    A body without a joint has three of MuJoCo's: two slides and a hinge. A joint of the task is one
    of MuJoCo's. Friction with the table takes velocity away at the rate d: force -m d v, torque
    -J d ω at each body's centre, by dampers that hang on sites, as the joints of a tree of bodies
    do not have the velocities of their bodies.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene, self.unit = scene, scene.size
        self._units = (self.unit, self.unit, 1.0)  # of x, y, θ
        self.kg = scene.bodies[0].mass
        self.step_s = scene.push_s / _STEPS
        self.advance = scene.stride / self.unit / _STEPS  # of the robot per step
        # Of qpos: the body, and 0 to 2 for its x, y or θ, or _VALUE for the value of its joint.
        self.coordinates: list[tuple[int, int]] = []
        self._root = ElementTree.Element("mujoco")
        compiler = {"angle": "radian", "inertiafromgeom": "false"}
        ElementTree.SubElement(self._root, "compiler", compiler)
        option = ElementTree.SubElement(
            self._root,
            "option",
            timestep=_words(self.step_s),
            gravity="0 0 0",
            integrator="implicitfast",
            cone="elliptic",
            iterations="50",
            tolerance="1e-10",
        )
        # Without a warm start a push depends on its arguments alone.
        ElementTree.SubElement(
            option, "flag", multiccd="enable", warmstart="disable", autoreset="disable"
        )
        self._assets = ElementTree.SubElement(self._root, "asset")
        world = ElementTree.SubElement(self._root, "worldbody")
        self._actuators = ElementTree.Element("actuator")
        self._children: dict[int, list[Joint]] = {}
        for joint in scene.joints:
            self._children.setdefault(joint.parent, []).append(joint)
        self._joint_of = {joint.child: joint for joint in scene.joints}
        self._roots = [i for i in range(len(scene.bodies)) if i not in self._joint_of]
        self._add_servo()
        for i in self._roots:
            self._add_root(world, i)
        self._add_contacts()
        self._root.append(self._actuators)

    @property
    def xml(self) -> str:
        return ElementTree.tostring(self._root, "unicode")

    def coordinates_of(self, states: Floats) -> Floats:
        """Returns qpos. [N, bodies, 3] -> [N, nq]"""
        out = np.empty((len(states), len(self.coordinates)))
        for k, (i, column) in enumerate(self.coordinates):
            if column == _VALUE:
                out[:, k] = self._value(self._joint_of[i], states)
            else:
                out[:, k] = states[:, i, column] / self._units[column]
        return out

    def _value(self, joint: Joint, states: Floats) -> Floats:
        parent, child = states[:, joint.parent], states[:, joint.child]
        if joint.type == "revolute":
            value: Floats = child[:, 2] - parent[:, 2]
            return value
        ends = child[:, :2] + _turned(child[:, 2], joint.on_child)
        begins = parent[:, :2] + _turned(parent[:, 2], joint.on_parent)
        value = ((ends - begins) * _turned(parent[:, 2], joint.axis)).sum(1) / self.unit
        return value

    def states_of(self, coordinates: Floats, before: Floats) -> Floats:
        """Returns the states that qpos tells. Fixed bodies stay. [N, nq] -> [N, bodies, 3]"""
        states = before.copy()
        values = np.zeros((len(before), len(self.scene.bodies)))
        for k, (i, column) in enumerate(self.coordinates):
            if column == _VALUE:
                values[:, i] = coordinates[:, k]
            else:
                states[:, i, column] = coordinates[:, k] * self._units[column]
        for i in self._roots:
            self._place_children(i, values, states)
        return states

    def _place_children(self, i: int, values: Floats, states: Floats) -> None:
        for joint in self._children.get(i, []):
            parent, child = states[:, i], states[:, joint.child]
            value = values[:, joint.child]
            child[:, 2] = parent[:, 2] + (value if joint.type == "revolute" else joint.angle)
            slide = value * self.unit if joint.type == "prismatic" else np.zeros(len(states))
            child[:, :2] = (
                parent[:, :2]
                + _turned(parent[:, 2], joint.on_parent)
                + slide[:, None] * _turned(parent[:, 2], joint.axis)
                - _turned(child[:, 2], joint.on_child)
            )
            self._place_children(joint.child, values, states)

    def _add_servo(self) -> None:
        """The robot follows its way by springs, whose force and torque are bounded."""
        scene = self.scene
        radius = max(
            float(np.linalg.norm(part.vertices, axis=1).max()) + part.radius
            for part in scene.bodies[0].parts
        )
        radius /= self.unit
        drag = scene.damping * self.advance / self.step_s  # of the robot at the speed of a push
        stiffness = drag / _LAG
        force, torque = scene.force_factor * drag, scene.torque_factor * drag * radius
        for name, spring, most in (
            ("x", stiffness, force),
            ("y", stiffness, force),
            ("theta", stiffness * radius**2, torque),
        ):
            ElementTree.SubElement(
                self._actuators,
                "position",
                joint=f"0 {name}",
                kp=_words(spring),
                forcelimited="true",
                forcerange=_words(-most, most),
            )

    def _add_root(self, world: ElementTree.Element, i: int) -> None:
        if self.scene.bodies[i].fixed:
            x, y, theta = self.scene.start[i]
            self._add_body(world, i, np.array([x, y]) / self.unit, theta, [])
            return
        joints = []
        for name, axis in zip(_COLUMNS, ("1 0 0", "0 1 0", "0 0 1"), strict=False):
            kind = "hinge" if name == "theta" else "slide"
            joints.append({"name": f"{i} {name}", "type": kind, "axis": axis})
        self._add_body(world, i, _STILL, 0.0, joints)

    def _add_body(
        self,
        parent: ElementTree.Element,
        i: int,
        at: Floats,
        angle: float,
        free: list[dict[str, str]],
    ) -> None:
        """`free`: the attributes of MuJoCo's joints, which let the body move in its parent."""
        body = self.scene.bodies[i]
        node = ElementTree.SubElement(
            parent, "body", name=str(i), pos=_words(*at, 0.0), euler=_words(0.0, 0.0, angle)
        )
        for attributes in free:
            ElementTree.SubElement(node, "joint", attributes)
            self.coordinates.append((i, _COLUMNS.index(attributes["name"].split()[1])))
        if not body.fixed:
            mass = body.mass / self.kg
            moment = body.moment / (self.kg * self.unit**2)
            ElementTree.SubElement(
                node,
                "inertial",
                pos="0 0 0",
                mass=_words(mass),
                diaginertia=_words(moment, moment, moment),
            )
            self._add_drag(node, i, mass, moment)
        for k in range(len(body.parts)):
            self._add_part(node, i, k)
        for joint in self._children.get(i, []):
            self._add_child(node, joint)

    def _add_drag(self, node: ElementTree.Element, i: int, mass: float, moment: float) -> None:
        ElementTree.SubElement(node, "site", name=str(i))
        for axis, inertia in ((0, mass), (1, mass), (5, moment)):
            gear = np.zeros(6)
            gear[axis] = 1.0
            ElementTree.SubElement(
                self._actuators,
                "general",
                site=str(i),
                gear=_words(*gear),
                biastype="affine",
                gainprm="0",
                biasprm=_words(0.0, 0.0, -inertia * self.scene.damping),
            )

    def _add_part(self, node: ElementTree.Element, i: int, k: int) -> None:
        part = self.scene.bodies[i].parts[k]
        vertices, radius = part.vertices / self.unit, part.radius / self.unit
        name = f"{i} {k}"
        geom = {"name": name, "contype": "0", "conaffinity": "0"}
        if len(vertices) == 1:
            ElementTree.SubElement(
                node,
                "geom",
                geom,
                type="cylinder",
                size=_words(radius, 0.5),
                pos=_words(*vertices[0], 0.0),
            )
            return
        if radius > 0.0:
            arc = radius * np.stack([np.cos(_ARC), np.sin(_ARC)], 1)
            vertices = (vertices[:, None] + arc).reshape(-1, 2)
        points = [_words(x, y, z) for z in (-0.5, 0.5) for x, y in vertices]
        ElementTree.SubElement(self._assets, "mesh", name=name, vertex=" ".join(points))
        ElementTree.SubElement(node, "geom", geom, type="mesh", mesh=name)

    def _add_child(self, node: ElementTree.Element, joint: Joint) -> None:
        """Places the child so that the joint is closed where its value is 0."""
        on_parent, on_child = joint.on_parent / self.unit, joint.on_child / self.unit
        made = []
        if joint.type != "fixed":
            revolute = joint.type == "revolute"
            unit = 1.0 if revolute else self.unit
            axis = (0.0, 0.0, 1.0) if revolute else (*_turned(-joint.angle, joint.axis), 0.0)
            made.append(
                {
                    "name": f"{joint.child} value",
                    "type": "hinge" if revolute else "slide",
                    "pos": _words(*on_child, 0.0),
                    "axis": _words(*axis),
                    **self._limits(joint.lower / unit, joint.upper / unit),
                }
            )
        at = on_parent - _turned(joint.angle, on_child)
        self._add_body(node, joint.child, at, joint.angle, made)

    def _limits(self, lower: float, upper: float) -> dict[str, str]:
        if not np.isfinite([lower, upper]).any():
            return {"limited": "false"}
        far = 1e6
        return {
            "limited": "true",
            "range": _words(max(lower, -far), min(upper, far)),
            "solreflimit": self._stiffness(),
            "solimplimit": "0.99 0.99 0.001",
        }

    def _stiffness(self) -> str:
        return _words(2.0 * self.step_s, 1.0)  # the stiffest contact that MuJoCo holds stable

    def _add_contacts(self) -> None:
        contacts = ElementTree.SubElement(self._root, "contact")
        joined = {(joint.parent, joint.child) for joint in self.scene.joints}
        bodies = self.scene.bodies
        for j in range(len(bodies)):
            for i in range(j):
                if (i, j) in joined or (j, i) in joined or (bodies[i].fixed and bodies[j].fixed):
                    continue
                self._add_pairs(contacts, (i, bodies[i]), (j, bodies[j]))

    def _add_pairs(
        self, contacts: ElementTree.Element, a: tuple[int, Body], b: tuple[int, Body]
    ) -> None:
        friction = np.sqrt(a[1].friction * b[1].friction)
        for k in range(len(a[1].parts)):
            for m in range(len(b[1].parts)):
                ElementTree.SubElement(
                    contacts,
                    "pair",
                    geom1=f"{a[0]} {k}",
                    geom2=f"{b[0]} {m}",
                    condim="3",
                    friction=_words(friction, friction, 0.0, 0.0, 0.0),
                    solref=self._stiffness(),
                    solimp="0.99 0.99 0.001",
                    margin=_words(_SKIN),
                )


class MuJoCo:
    """MuJoCo, as `rtg.engines.Engine`.

    A push is some hundred steps along the way, then some with the robot held. Contacts are as stiff
    as the step allows. Equal arguments give equal bits on one machine.
    """

    def __init__(self, scene: Scene) -> None:
        mujoco = extras.imported("mujoco", "mujoco", "forward.engine mujoco")
        self._rollout = extras.imported("mujoco.rollout", "mujoco", "forward.engine mujoco")
        self.version: str = mujoco.__version__
        self._scene, self._made = scene, _Model(scene)
        self._model = mujoco.MjModel.from_xml_string(self._made.xml)
        threads = len(os.sched_getaffinity(0))
        self._data = [mujoco.MjData(self._model) for _ in range(threads)]
        self._size = mujoco.mj_stateSize(self._model, mujoco.mjtState.mjSTATE_FULLPHYSICS)

    def push(self, states: Floats, ways: Floats) -> tuple[Floats, Bools]:
        ends, ok = states.copy(), np.ones(len(states), np.bool_)
        moving = np.flatnonzero(ways.any(1))
        free = moving[self._scene.is_free(states[moving], ways[moving])]
        ends[free, 0, :2] += ways[free]
        simulated = np.setdiff1d(np.arange(len(states)), free)
        for some in np.array_split(simulated, -(-len(simulated) // _BATCH) or 1):
            if len(some):
                ends[some], ok[some] = self._simulated(states[some], ways[some])
        return ends, ok

    def _simulated(self, states: Floats, ways: Floats) -> tuple[Floats, Bools]:
        unit, advance = self._made.unit, self._made.advance
        lengths = np.linalg.norm(ways, axis=1) / unit
        most = np.ceil(lengths / advance).astype(np.int64) + _LATE_STEPS
        done = np.arange(1, most.max() + 1) * advance / np.maximum(lengths, advance)[:, None]
        way = np.zeros((len(states), most.max(), 3))
        way[:, :, :2] = np.minimum(done, 1.0)[:, :, None] * (ways / unit)[:, None]
        began = np.zeros((len(states), self._size))
        began[:, 1 : 1 + self._model.nq] = self._made.coordinates_of(states)
        pushed = self._rolled(began, began[:, None, 1:4] + way)
        pushed = pushed[np.arange(len(states)), most - 1]
        # The robot stays where its force has taken it, until all have come to rest.
        held = np.repeat(pushed[:, None, 1:4], _REST_STEPS, 1)
        last, moving = pushed, np.arange(len(states))
        for _ in range(_REST_ROLLS):
            last[moving] = self._rolled(last[moving], held[moving])[:, -1]
            moving = moving[~self._rests(last[moving, 1:])]
            if not moving.size:
                break
        ended = self._made.states_of(last[:, 1 : 1 + self._model.nq], states)
        return ended, ~np.isin(np.arange(len(states)), moving)

    def _rests(self, states: Floats) -> Bools:
        speeds = np.abs(states[:, self._model.nq : self._model.nq + self._model.nv])
        return np.asarray(np.isfinite(states).all(axis=1) & (speeds < _AT_REST).all(axis=1))

    def _rolled(self, states: Floats, robot: Floats) -> Floats:
        """Returns the states after each step. `robot`: where it is drawn to. [N, steps, 3]"""
        control = np.zeros((*robot.shape[:2], self._model.nu))
        control[:, :, :3] = robot
        with _POOL:
            after, _ = self._rollout.rollout(
                self._model, self._data, states, control, persistent_pool=True
            )
        return after
