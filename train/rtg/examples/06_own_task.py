"""A task of one's own: one YAML file, checked, and drawn with two starts and two goal states."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rtg

TASK = """
task:
  name: shelf
  bodies:
    - {name: robot, kind: robot, shape: {disc: 0.05}, start: [0, -0.4, 0]}
    - {name: book, kind: book, shape: {box: [0.2, 0.14]}, start: {x: [-0.2, 0.2], y: [-0.2, 0.1]}}
    - {name: wall, kind: wall, fixed: true, shape: {box: [1.4, 0.04]}, start: [0, 0.56, 0]}
  goal:
    - {kind: book, touching: wall, gap: 0.01}
    - {kind: book, angle: [-0.1, 0.1]}
  push: {headings: 48, stride: 0.1, arena: 0.6}
  horizon: 40
search: {transitions: 20000}
"""


def main(folder: Path) -> None:
    file = folder / "shelf.yaml"
    file.write_text(TASK)
    task = rtg.load_task(file)  # raises ValueError, with the line, for what is not legal
    print(task.description)
    states = [task.start(1), task.start(2), task.goal_state(1), task.goal_state(2)]

    figure, axes = plt.subplots(2, 2, figsize=(8, 8), layout="constrained")
    for axis, state, title in zip(axes.flat, states, ["start"] * 2 + ["goal"] * 2, strict=True):
        axis.imshow(task.image(np.asarray(state)[None]))
        axis.set_title(title)
        axis.axis("off")
    figure.savefig(folder / "06_own_task.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
