"""Transitions as arrays: what the search stores, and where it has been."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rtg


def main(folder: Path) -> None:
    task = rtg.load_task("sorting")
    data = rtg.Transitions.joined(rtg.generate(task, 3000, seed=1))
    observations = task.observation(data.states)
    print(f"{len(data)} transitions, observations {observations.shape}")
    print("an observation:", ", ".join(task.observation_names[:8]), "...")
    for k, source in enumerate(rtg.SOURCES):
        share, success = (data.source == k).mean(), data.success[data.source == k]
        if len(success):
            print(f"{source}: {share:.0%} of the data, {success.mean():.0%} reach the goal")

    axes = plt.figure(figsize=(6, 6)).gca()
    moved = np.abs(data.next_states - data.states)[:, 1:, :2].max(axis=2) > 0.05
    for body, name in enumerate(task.bodies[1:]):
        rows = moved[:, body]
        axes.plot(*data.states[rows, 1 + body, :2].T, ".", ms=3, label=f"{name}: {rows.sum()}")
    axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title="Where pushes move the boxes")
    axes.legend(title="box: pushes")
    axes.figure.savefig(folder / "05_transitions.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
