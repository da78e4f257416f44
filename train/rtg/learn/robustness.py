"""Evaluates a trained policy where it was not trained: other starts, noise, other physics."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rtg import _core
from rtg.learn.evaluation import FINAL_SEED, Values, evaluate

Floats = NDArray[np.float64]

# Lengths are for a robot of 0.8 m radius, those of others are in proportion.
_MOVED = (0.1, 0.25, 0.5, 1.0, 2.0)
_TURNED = (0.25, 0.5, 1.0)  # [rad]
_NOISE = (0.02, 0.05, 0.1)  # also [rad]
_FACTORS = (0.5, 0.7, 1.3, 2.0)  # of friction and of masses
_STRIDES = (0.75, 0.9, 1.1, 1.25)  # factors
_COASTING = (10.0, 4.0, 2.0)  # physics.damping, with inertia
_NOISE_SEED = 5
_REASON_LENGTH = 100  # characters, of why a variant is not possible


class Variant(NamedTuple):
    """A difference from the training: settings of the configuration, and noise of the poses."""

    group: str  # what differs, in words
    label: str  # by how much
    settings: tuple[str, ...] = ()
    noise: float = 0.0  # standard deviation of the poses that the policy sees


class Row(NamedTuple):
    """The result of a variant; without figures, but with a reason, if its settings are refused."""

    variant: Variant
    success: float | None
    length: float | None  # actions per episode
    reason: str | None = None


def _turned(task: dict[str, Any], by: float, shift: float) -> tuple[str, ...]:
    """Returns settings that turn each loose object by up to `by` [rad], and move it by `shift`.

    Leaves out objects that a goal term wants to stay: they must not start in ranges.
    """
    jointed = {
        name for joint in task.get("joints", ()) for name in (joint["parent"], joint["child"])
    }
    staying = {term["kind"] for term in task["goal"] if "stays" in term}
    found = []
    for k, body in enumerate(task["bodies"]):
        if k == 0 or body["fixed"] or body["name"] in jointed or staying & {body["kind"], "*"}:
            continue
        x, y, theta = body["start"]
        ranges = f"x: {_range(x, shift)}, y: {_range(y, shift)}, theta: {_range(theta, by)}"
        found.append(f"task.bodies.{k}.start={{{ranges}}}")
    return tuple(found)


def _range(x: float, spread: float) -> str:
    return f"[{x - spread}, {x + spread}]"


def _start_variants(task: dict[str, Any], unit: float) -> Iterator[Variant]:
    arena = task["push"]["arena"]
    if isinstance(task["bodies"][0]["start"], list):
        theta = task["bodies"][0]["start"][2]
        anywhere = f"{{x: [{-arena}, {arena}], y: [{-arena}, {arena}], theta: {theta}}}"
        yield Variant("robot", "anywhere", (f"task.bodies.0.start={anywhere}",))
    if not all(isinstance(body["start"], list) for body in task["bodies"][1:]):
        return  # starts are drawn from ranges already
    for by in _MOVED:
        yield Variant(
            "objects moved",
            f"by up to {by * unit:.3g} m",
            (f"task.start_jitter={by * unit}", "train.randomise=false"),
        )
    for by in _TURNED:
        if settings := _turned(task, by, _MOVED[0] * unit):
            yield Variant("objects turned", f"by up to {by} rad", settings)


def variants(config: _core.Config) -> list[Variant]:
    """Returns the variants of a task, the trained one first."""
    task = json.loads(config.json)["task"]
    unit = 1.0 / config.task.metre
    found = [Variant("as trained", ""), *_start_variants(task, unit)]
    found += [Variant("noise of poses", f"{by * unit:.3g} m, {by} rad", noise=by) for by in _NOISE]
    for factor in _FACTORS:
        for group, key in (("friction", "friction"), ("mass of objects", "density")):
            settings = tuple(
                f"task.bodies.{k}.{key}={body[key] * factor}"
                for k, body in enumerate(task["bodies"])
                if key == "friction" or k > 0
            )
            found.append(Variant(group, f"x {factor}", settings))
    for factor in _STRIDES:
        strides = [stride * factor for stride in task["push"]["strides"]]
        found.append(Variant("stride", f"x {factor}", (f"task.push.strides={strides}",)))
    for damping in _COASTING:
        settings = ("physics.inertia=true", f"physics.damping={damping}")
        found.append(Variant("coasting", f"damping {damping}", settings))
    return sorted(found, key=lambda variant: [v.group for v in found].index(variant.group))


def _seen(task: _core.Task, noise: float) -> Callable[[Floats], NDArray[np.float32]]:
    """Returns what the policy sees of states: the observation of its own task, with noise."""
    rng = np.random.default_rng(_NOISE_SEED)

    def observe(states: Floats) -> NDArray[np.float32]:
        if noise > 0.0:
            states = states + noise * rng.standard_normal(states.shape)
        return task.observation(states)

    return observe


def _shortened(error: _core.ConfigError) -> str:
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
    starts = np.stack(
        [
            changed.task.jittered_start(changed.evaluation_jitter, FINAL_SEED, k)
            for k in range(episodes)
        ]
    )
    observe = _seen(config.task, variant.noise)
    found = evaluate(changed, values, starts, config.learner_discount, observe)
    return Row(variant, float(found.success.mean()), float(found.length.mean()))
