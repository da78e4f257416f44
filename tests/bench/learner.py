"""Measures gradient steps of the learner on one core, against what the processor can do.

    learner.py [--smoke]

Prints the times, in thread-CPU time, medians of interleaved repetitions, and two gates (design 6):

- `learner.arithmetic_limit`: the time of the step's matrix products at the speed of a large product
  of the same precision, as a share of the time of a whole step: sampling, targets, gradient,
  optimiser, averages and statistics;
- `learner.bare_loop`: the time of a step on one batch over and over, without sampling and
  statistics, as a share of the same.

--smoke repeats little and leaves out the gates. Exit status 1 if a gate failed.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable, Sequence

import numpy as np
import torch as th
from gates import gate
from rtg import _core, paths
from rtg.envs.training_environments import TrainingEnvironments
from rtg.files.dataset import Transitions
from rtg.learn.ddqn import DoubleDqn, core_batch
from rtg.learn.networks import HeadingNetwork

TASK = "gathering"
ROWS = 49_000  # offline transitions, and as many online ones
PRODUCT = (256, 512, 512)  # shape of the large product


def learner() -> DoubleDqn:
    """Makes a learner of the default settings with random transitions."""
    config = _core.Config.from_file(paths.CONFIG / f"{TASK}.yaml", [])
    env = TrainingEnvironments(config, 4, config.training_jitter, 1, None)
    one = DoubleDqn(env, config.train, config.learner_discount, seed=1)
    random = np.random.default_rng(1)
    seen = random.normal(size=(2, ROWS, env.observation_size)).astype(np.float32)
    reward = (random.random(ROWS) < 0.1).astype(np.float32)
    columns = {
        "action": random.integers(env.headings, size=ROWS),
        "reward": reward,
        "terminated": reward,
        "observation": seen[0],
        "next_observation": seen[1],
    }
    nothing = np.zeros((ROWS, env.task.bodies, 3))
    one.replay.add_offline(
        Transitions(poses=nothing, next_poses=nothing, source=np.zeros(ROWS, np.int8), **columns)
    )
    one.replay.online.append(**columns)
    return one


def multiplications(net: HeadingNetwork, batch: int) -> float:
    """Returns the number of multiplications in the matrix products of a gradient step.

    Values of all headings in s', then of one heading: by the target network, by the online network,
    and twice as many for the gradient of these.
    """
    inputs, headings, hidden, features, _ = net.sizes
    trunk = hidden * (inputs + hidden + 3 * features + 1)
    heading = features * (3 + features + 1)  # their sum along it, f's two layers
    first = hidden * inputs  # whose inputs need no gradient
    return float(batch * (trunk + headings * heading + 4 * (trunk + heading) - first))


def bare_step(one: DoubleDqn) -> Callable[[], object]:
    """Returns the learner's step on a batch that stays the same."""
    assert one._core
    batch = core_batch(one.replay.sample(one.settings.batch))
    rates = _core.StepRates(step=1, learning=1e-6, target=0.01, mean=0.01)
    core, weights = one._core, one._core_weights()
    return lambda: core.step(weights, batch, rates, threads=1)


def medians(
    functions: dict[str, Callable[[], object]], repetitions: int, calls: int
) -> dict[str, float]:
    """Returns the time of each function [s], by its name."""
    times: dict[str, list[float]] = {name: [] for name in functions}
    for _ in range(repetitions):
        for name, function in functions.items():
            begin = time.thread_time()
            for _ in range(calls):
                function()
            times[name].append((time.thread_time() - begin) / calls)
    return {name: statistics.median(found) for name, found in times.items()}


def main(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(description="Measures gradient steps.")
    parser.add_argument("--smoke", action="store_true")
    smoke = parser.parse_args(words).smoke
    th.set_num_threads(1)
    one = learner()
    assert isinstance(one.online, HeadingNetwork)
    left, right = th.randn(PRODUCT[0], PRODUCT[1]), th.randn(PRODUCT[1], PRODUCT[2])
    times = medians(
        {
            "step": lambda: one.train(1),
            "bare step": bare_step(one),
            "product": lambda: th.mm(left, right),
        },
        *((1, 2) if smoke else (15, 60)),
    )
    needed = multiplications(one.online, one.settings.batch)
    limit = times["product"] * needed / float(np.prod(PRODUCT))
    for name, value in {**times, "limit of a step": limit}.items():
        print(f"{name} {1e3 * value:.3f} ms")
    if smoke:
        return 0
    held = (
        gate("learner.arithmetic_limit", limit / times["step"], ">=", 0.7),
        gate("learner.bare_loop", times["bare step"] / times["step"], ">=", 0.9),
    )
    return 0 if all(held) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
