"""The reverse simulator: from which states does each push lead to this goal state?"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rtg


def main(folder: Path) -> None:
    task = rtg.load_task("push_t")
    goal = task.goal_state(seed=3)
    found = rtg.ReverseSimulator(task).solve(goal, range(task.actions))
    solved = found.solved.nonzero()[0]
    print(f"{len(solved)} of {task.actions} pushes end in the goal state")

    # Of the push that moves the T farthest: where everything was, sub-step by sub-step, and forces.
    travel = [abs(found.trajectory[a, -1, 1] - found.trajectory[a, 0, 1]).sum() for a in solved]
    action = solved[max(range(len(solved)), key=travel.__getitem__)]
    forces = found.contacts
    of_it = (forces.solve == action) & (forces.sub_step > 0)

    axes = plt.figure(figsize=(6, 6)).gca()
    trajectory = found.trajectory[action]
    colours = plt.cm.viridis(np.linspace(0, 1, len(trajectory)))
    for colour, state in zip(colours, trajectory, strict=True):
        for rings in task.outlines(state):
            axes.fill(*rings[0].T, facecolor="none", edgecolor=colour, lw=0.8)
    push = -forces.force[of_it, None] * forces.normal[of_it]
    axes.quiver(*forces.point[of_it].T, *push.T, color="crimson", width=0.004)
    axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axes.set_title(f"Push {action}: from blue to yellow, contact forces in red")
    axes.figure.savefig(folder / "01_reverse_pushes.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
