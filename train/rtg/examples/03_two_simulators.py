"""One push in two forward simulators, and how far apart they end."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rtg


def main(folder: Path) -> None:
    task = rtg.load_task("gathering")
    starts = np.stack([task.goal_state(seed) for seed in range(100)])
    actions = np.arange(100) % task.actions
    newton, ok = rtg.forward.Newton(task).push(starts, actions)
    box2d, finished = rtg.forward.Box2D(task).push(starts, actions)
    moved = np.abs(box2d[:, 1:] - starts[:, 1:]).max(axis=(1, 2)) > 0.1
    used = ok & finished & moved
    apart = np.linalg.norm((newton - box2d)[used, 1:, :2], axis=2).max(axis=1)
    print(f"{used.sum()} pushes move a box; they end {np.median(apart):.3f} m apart in the median")

    figure, axes = plt.subplots(1, 3, figsize=(9, 3.5), layout="constrained")
    push = np.flatnonzero(used)[apart.argmax()]
    for axis, state, title in zip(
        axes, (starts[push], newton[push], box2d[push]), ("before", "Newton", "Box2D"), strict=True
    ):
        axis.imshow(task.image(state[None]))
        axis.set_title(title)
        axis.axis("off")
    figure.savefig(folder / "03_two_simulators.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
