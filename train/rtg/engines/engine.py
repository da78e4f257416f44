"""The seam between RTG and a forward simulator."""

from __future__ import annotations

import hashlib
import importlib
import inspect
import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.engines.scene import Bools, Floats, Scene
from rtg.errors import RunError, UserError

Integers = NDArray[np.int64]
_STILL = 1e-5  # by which fixed bodies may differ [m, rad], the robot having a radius of 0.8

_OURS = {"mujoco": "rtg.engines.mujoco:MuJoCo"}
ENGINES = ("box2d", "newton", *_OURS)  # which need no class of the user's


Replay = Callable[[Floats, Integers], tuple[Floats, Bools]]


class EngineError(RunError):
    """A forward simulator failed: its traceback, and the state in which it did."""


class Engine(Protocol):
    """What a class must offer to be a `forward.engine: module:Class`.

    It holds no state of an episode: equal arguments give equal results, in whatever order. It may
    have an attribute `version`, a text that changes whenever results do; without one, the source
    file of the class serves as such.
    """

    def __init__(self, scene: Scene) -> None:
        """Makes the simulator of a scene."""

    def push(self, states: Floats, ways: Floats) -> tuple[Floats, Bools]:
        """Simulates a push from each state. [N, bodies, 3], [N, 2] -> [N, bodies, 3], [N]

        The robot goes its way (x, y) [m] straight ahead without turning, as far as its force
        suffices; then all bodies come to rest. If the way is 0, they come to rest while the robot
        stays. Returns the states at rest, x [m], y [m], θ [rad], and which pushes could be
        simulated.
        """
        ...


class Simulator(Protocol):
    """A forward simulator in the units of the core, as `_core.Simulator` is one."""

    def push(self, states: Floats, actions: Integers) -> tuple[Floats, Bools]:
        """Simulates an action in each state. [N, bodies, 3], [N] -> [N, bodies, 3], [N]"""
        ...

    def push_along(self, states: Floats, ways: Floats) -> tuple[Floats, Bools]:
        """The same with a way (x, y) of the robot instead of an action. [N, 2]"""
        ...


class _Outer:
    """An Engine as a Simulator.

    Robots end in the arena, states have single precision, and pushes that could not be simulated
    leave them as they are. So do those after which bodies overlap or are out of twice the arena.
    """

    def __init__(self, config: _core.Config) -> None:
        self._config, self._task = config, config.task
        self._name: str = config.forward.engine
        made = _class_of(self._name)
        self._engine: Engine = self._guarded(
            lambda: made(Scene(config)), "when it was made", (UserError, RunError)
        )
        own: Any = self._guarded(lambda: getattr(self._engine, "version", None), "for its version")
        if own is not None and not (isinstance(own, str) and own.isprintable()):
            raise UserError(f"{self._prefix()}: its version is {own!r}; legal: a text of one line")
        parts = [own or "", "" if own and self._name not in _OURS else _source_digest(made)]
        self.version = " ".join(filter(None, parts))

    def __reduce__(self) -> tuple[Callable[[_core.Config], Simulator], tuple[_core.Config]]:
        return simulator, (self._config,)

    def push(self, states: Floats, actions: Integers) -> tuple[Floats, Bools]:
        ways = np.zeros((len(actions), 2))
        pushes = actions != _core.SETTLE
        ways[pushes] = self._task.ways(np.ascontiguousarray(actions[pushes]))
        return self.push_along(states, ways)

    def push_along(self, states: Floats, ways: Floats) -> tuple[Floats, Bools]:
        if not len(states):
            return states.copy(), np.ones(0, np.bool_)
        metre = [self._task.metre, self._task.metre, 1.0]
        arena = self._task.arena
        robot = states[:, 0, :2]
        inside = np.clip(robot + ways, -arena, arena) - robot
        ends, ok = self._checked(states / metre, inside / self._task.metre)
        with np.errstate(over="ignore"):  # is_legal() refuses infinite ones
            after = (ends * metre).astype(np.float32).astype(np.float64)
        fixed = self._task.fixed
        after[:, fixed] = states[:, fixed]
        ok = ok & self._task.is_legal(after)
        return np.where(ok[:, None, None], after, states), ok

    def _checked(self, states: Floats, ways: Floats) -> tuple[Floats, Bools]:
        """Asks the engine; if it fails, state by state, to tell of the one at fault."""
        try:
            answer = self._engine.push(states.copy(), ways.copy())
        except (Exception, SystemExit) as error:
            failure = error
        else:
            return self._answer(answer, states)
        for state, way in zip(states, ways, strict=True):
            where = f"in the state {state.tolist()} with the way {way.tolist()}"
            self._guarded(partial(self._engine.push, state[None].copy(), way[None].copy()), where)
        where = f"in a batch of {len(states)} states, but in none of them alone"
        raise self._failure(failure, where) from None  # its text has the traceback

    def _answer(self, answer: Any, states: Floats) -> tuple[Floats, Bools]:
        """Returns what the engine has returned for `states`, if it has the right shapes."""
        try:
            ends, ok = (np.asarray(part) for part in answer)
            if ends.shape != states.shape or ok.shape != (len(states),) or ok.dtype != np.bool_:
                raise ValueError(
                    f"arrays {ends.shape} of {ends.dtype} and {ok.shape} of {ok.dtype}"
                )
            ends = ends.astype(np.float64)
            if (wrong := ok & ~np.isfinite(ends).all((1, 2))).any():
                where = states[wrong][0].tolist()
                raise ValueError(f"with True numbers that are not finite for the state {where}")
            way = (ends - states)[:, self._task.fixed] * [self._task.metre, self._task.metre, 1.0]
            way[..., 2] = np.remainder(way[..., 2] + np.pi, 2.0 * np.pi) - np.pi
            moved = np.abs(way).max((1, 2), initial=0.0) > _STILL
            if (wrong := ok & moved).any():
                where = states[wrong][0].tolist()
                raise ValueError(f"with True fixed bodies that have moved, for the state {where}")
            return ends, ok
        except (TypeError, ValueError) as error:
            raise EngineError(
                f"{self._prefix()} returned {error}; legal: states {states.shape} of numbers and "
                f"({len(states)},) of bool"
            ) from error

    def _guarded(
        self, call: Callable[[], Any], when: str, ours: tuple[type[Exception], ...] = (EngineError,)
    ) -> Any:
        """Turns what a call raises into an EngineError, but for errors that are ours already."""
        try:
            return call()
        except ours:
            raise
        except (Exception, SystemExit) as error:
            raise self._failure(error, when) from None

    def _failure(self, error: BaseException, when: str) -> EngineError:
        return EngineError(f"{self._prefix()} failed:\n{_lines(error)}\n{when}")

    def _prefix(self) -> str:
        return f"forward.engine {self._name}"


def _lines(error: BaseException) -> str:
    """Returns the traceback without the frames of this file."""
    trace = error.__traceback__
    while trace and trace.tb_next and trace.tb_frame.f_code.co_filename == __file__:
        trace = trace.tb_next
    return "".join(traceback.format_exception(type(error), error, trace)).rstrip()


def _source_digest(made: Callable[[Scene], Engine]) -> str:
    """Returns the beginning of the SHA-256 of the file of a class, and of what stands around it.

    Returns "?" if the class has no file.
    """
    try:
        files = [Path(inspect.getfile(one)) for one in (made, _Outer, Scene)]
        source = b"".join(file.read_bytes() for file in files)
    except (TypeError, OSError):
        return "?"
    return f"sha256:{hashlib.sha256(source).hexdigest()[:12]}"


def _class_of(name: str) -> Callable[[Scene], Engine]:
    """Returns the class that `name` stands for. Raises UserError if there is none."""
    module, _, made = _OURS.get(name, name).partition(":")
    try:
        found = getattr(importlib.import_module(module), made)
    except ModuleNotFoundError as error:
        if error.name and not f"{module}.".startswith(f"{error.name}."):
            raise EngineError(
                f"forward.engine {name} failed on import:\n{_lines(error)}"
            ) from error
        raise UserError(
            f"forward.engine {name}: there is no module {error.name}; legal: one on the path of "
            "Python (PYTHONPATH) or in this folder"
        ) from None
    except AttributeError:
        raise UserError(
            f"forward.engine {name}: the module {module} has no {made}; legal: a class in it"
        ) from None
    if not callable(getattr(found, "push", None)):
        raise UserError(
            f"forward.engine {name}: has no method push; legal: a class as rtg.engines.Engine"
        )
    made_by: Callable[[Scene], Engine] = found
    return made_by


def simulator(config: _core.Config) -> Simulator:
    """Returns the forward simulator that a configuration names.

    Raises UserError if there is none, EngineError if it cannot be made.
    """
    if config.has_built_in_engine:
        return _core.Simulator(config)
    return _Outer(config)


def identity(config: _core.Config) -> str:
    """Returns the name and version of the forward simulator that a configuration names.

    What simulators of different identities say is not mixed. Raises as simulator() does.
    """
    name, friction = config.forward.engine, config.forward.friction
    version = _core.BOX2D_VERSION if name == "box2d" else ""
    if not config.has_built_in_engine:
        version = _Outer(config).version
    own_friction = f"friction x {friction:g}" if friction != 1.0 else ""
    return " ".join(filter(None, (name, version, own_friction)))


def replay_function(config: _core.Config) -> Replay | None:
    """Returns what the core is to ask for replays; None if the engine is built in."""
    return None if config.has_built_in_engine else simulator(config).push
