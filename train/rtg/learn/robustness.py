"""Evaluates a trained policy where it was not trained: other starts, noise, other physics."""

from __future__ import annotations

import json
import math
import re
import textwrap
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.engines import ENGINES, EngineError
from rtg.errors import UserError
from rtg.learn.evaluation import Values, evaluate, final_starts

Floats = NDArray[np.float64]

# Lengths are for a robot of 0.8 m radius, those of others are in proportion.
_MOVED = (0.0, 0.1, 0.25, 0.5, 1.0, 2.0)
_TURNED_SHIFT = 0.1  # objects that turn also move by up to so much
_TURNED = (0.25, 0.5, 1.0)  # [rad]
_FULL_TURN = 2.0 * math.pi - 1e-3  # less, as files round it [rad]
_NOISE = (0.02, 0.05, 0.1)  # also [rad]
_FACTORS = (0.5, 0.7, 1.3, 2.0)  # of friction and of masses
_STRIDES = (0.75, 0.9, 1.1, 1.25)  # factors
_COASTING = (10.0, 4.0, 2.0)  # physics.damping, with inertia
_NOISE_SEED = 5
AS_TRAINED = "as trained"  # the group of the variant without a difference
_SIMULATOR = "simulator"  # the group of other forward simulators
_REASON_LENGTH = 100  # characters, of why a variant is not possible


class Variant(NamedTuple):
    """A difference from the training: settings of the configuration, and noise of the poses."""

    group: str  # what differs, in words
    label: str  # by how much
    settings: tuple[str, ...] = ()
    noise: float = 0.0  # standard deviation of the poses that the policy sees
    amount: float | None = None  # [m], [rad] or a factor, where a report draws the group over it


class Row(NamedTuple):
    """The result of a variant; without figures, but with a reason, if its settings are refused."""

    variant: Variant
    success: float | None
    length: float | None  # actions per episode
    reason: str | None = None


def _around(x: float, spread: float) -> list[float]:
    return [x - spread, x + spread]


def _wider(ends: Sequence[float], by: float, bound: float = math.inf) -> list[float]:
    """Returns a range with both ends `by` farther out, or as far as `bound` lets both of them.

    The middle stays: that is where bodies that joints connect with this one belong.
    """
    low, high = ends
    spread = max(0.0, min(by, bound - high, bound + low))
    return [low - spread, high + spread]


def _grown(ring: Sequence[Sequence[float]], by: float) -> list[list[float]]:
    """Moves the edges of a convex, counter-clockwise ring outwards. [V, 2] -> [V, 2]"""
    corners = np.array(ring)
    edges = np.roll(corners, -1, axis=0) - corners
    after = np.stack((edges[:, 1], -edges[:, 0]), axis=1)
    after /= np.linalg.norm(edges, axis=1)[:, None]
    sums = after + np.roll(after, 1, axis=0)  # of the normals of the edges at a corner
    found = corners + 2.0 * by * sums / (sums**2).sum(axis=1)[:, None]
    return [[float(x), float(y)] for x, y in found]


def _moved_range(start: dict[str, Any], by: float, arena: float) -> dict[str, Any]:
    """Returns the range of a start, wider by `by`; ranges of x and y stay within the arena."""
    if "in" not in start:
        return {**start, **{axis: _wider(start[axis], by, arena) for axis in ("x", "y")}}
    region = start["in"]
    if disc := region.get("disc"):
        return {**start, "in": {"disc": {**disc, "radius": disc["radius"] + by}}}
    return {**start, "in": {"polygon": _grown(region["polygon"], by)}}


def _turned_range(start: dict[str, Any], by: float) -> dict[str, Any]:
    """Returns the range of a start, wider in theta by `by` [rad], or a full turn."""
    return {**start, "theta": _wider(start["theta"], by, math.pi + sum(start["theta"]) / 2.0)}


def _starts(bodies: dict[int, dict[str, Any]]) -> tuple[str, ...]:
    return tuple(f"task.bodies.{k}.start={json.dumps(start)}" for k, start in bodies.items())


def _objects_in_ranges(task: dict[str, Any]) -> dict[int, dict[str, Any]]:
    """Returns the starts of the objects that are drawn from ranges already, by body."""
    starts = {k: body["start"] for k, body in enumerate(task["bodies"]) if k > 0}
    return {k: start for k, start in starts.items() if isinstance(start, dict)}


def _moved(task: dict[str, Any], by: float) -> tuple[str, ...]:
    """Returns settings that move objects by up to `by`: those of fixed places, from there, those
    of ranges, out of these."""
    ranges = _objects_in_ranges(task)
    wider = {k: _moved_range(start, by, task["push"]["arena"]) for k, start in ranges.items()}
    return (f"task.start_jitter={by}", "train.randomise=false", *_starts(wider))


def _turned(task: dict[str, Any], by: float, shift: float) -> tuple[str, ...]:
    """Returns settings that turn each loose object by up to `by` [rad], and move it by `shift`.

    Objects of ranges turn out of these, if they do not start at any angle already. Leaves out
    objects that a goal term wants to stay: they must not start in ranges.
    """
    jointed = {
        name for joint in task.get("joints", ()) for name in (joint["parent"], joint["child"])
    }
    staying = {term["kind"] for term in task["goal"] if "stays" in term}
    ranges = _objects_in_ranges(task)
    found = {
        k: _turned_range(start, by)
        for k, start in ranges.items()
        if np.ptp(start["theta"]) < _FULL_TURN
    }
    for k, body in enumerate(task["bodies"]):
        if k == 0 or k in ranges or body["fixed"]:
            continue
        if body["name"] in jointed or staying & {body["kind"], "*"}:
            continue
        x, y, theta = body["start"]
        found[k] = {"x": _around(x, shift), "y": _around(y, shift), "theta": _around(theta, by)}
    return _starts(found)


def _anywhere(task: dict[str, Any]) -> Iterator[Variant]:
    """Yields the variant with the robot anywhere in the arena, if it does not start so already."""
    whole, start = [-task["push"]["arena"], task["push"]["arena"]], task["bodies"][0]["start"]
    theta = start[2] if isinstance(start, list) else start["theta"]
    anywhere = {"x": whole, "y": whole, "theta": theta}
    if start != anywhere:
        yield Variant("robot", "anywhere", _starts({0: anywhere}))


def _start_variants(task: dict[str, Any], unit: float) -> Iterator[Variant]:
    yield from _anywhere(task)
    for by in _MOVED:
        moved, settings = by * unit, _moved(task, by * unit)
        yield Variant("objects moved", f"by up to {moved:.3g} m", settings, amount=moved)
    for by in _TURNED:
        if settings := _turned(task, by, _TURNED_SHIFT * unit):
            yield Variant("objects turned", f"by up to {by} rad", settings, amount=by)


def variants(config: _core.Config) -> list[Variant]:
    """Returns the variants of a task, the trained one first."""
    task = json.loads(config.json)["task"]
    unit = 1.0 / config.task.metre
    found = [Variant(AS_TRAINED, ""), *_start_variants(task, unit)]
    found += [
        Variant("noise of poses", f"{by * unit:.3g} m, {by} rad", noise=by, amount=by * unit)
        for by in _NOISE
    ]
    for factor in _FACTORS:
        for group, key in (("friction", "friction"), ("mass of objects", "density")):
            settings = tuple(
                f"task.bodies.{k}.{key}={body[key] * factor}"
                for k, body in enumerate(task["bodies"])
                if key == "friction" or k > 0
            )
            found.append(Variant(group, f"x {factor}", settings, amount=factor))
    for factor in _STRIDES:
        strides = [stride * factor for stride in task["push"]["strides"]]
        changed = (f"task.push.strides={strides}",)
        found.append(Variant("stride", f"x {factor}", changed, amount=factor))
    for damping in _COASTING:
        settings = ("physics.inertia=true", f"physics.damping={damping}")
        found.append(Variant("coasting", f"damping {damping}", settings))
    for engine in ENGINES:
        if engine != config.forward.engine:
            found.append(Variant(_SIMULATOR, engine, (f"forward.engine={engine}",)))
    return sorted(found, key=lambda variant: [v.group for v in found].index(variant.group))


def _seen(task: _core.Task, noise: float) -> Callable[[Floats], NDArray[np.float32]]:
    """Returns what the policy sees of states: the observation of its own task, with noise."""
    rng = np.random.default_rng(_NOISE_SEED)

    def observe(states: Floats) -> NDArray[np.float32]:
        if noise > 0.0:
            states = states + noise * rng.standard_normal(states.shape)
        return task.observation(states)

    return observe


def _shortened(error: Exception) -> str:
    """Returns the key and what is wrong with it, without the place and what is legal."""
    parts = re.search(r"key '(.*?)': (.*?); legal: ", str(error))
    words = ": ".join(parts.groups()) if parts else str(error)
    return textwrap.shorten(f"not possible: {words}", _REASON_LENGTH, placeholder=" ...")


def evaluate_variant(
    file: Path, config: _core.Config, values: Values, variant: Variant, episodes: int
) -> Row:
    """Simulates episodes from held-out starts of the variant. `file`, `config`: of the run."""
    try:
        changed = _core.Config.from_file(file, list(variant.settings))
    except _core.ConfigError as error:
        return Row(variant, None, None, _shortened(error))
    starts = final_starts(changed, episodes)
    observe = _seen(config.task, variant.noise)
    try:
        found = evaluate(changed, values, starts, config.learner_discount, observe)
    except (UserError, EngineError) as error:
        if variant.group != _SIMULATOR:  # the run's own is not to be had
            raise
        return Row(variant, None, None, _shortened(error))
    return Row(variant, float(found.success.mean()), float(found.length.mean()))
