"""Demonstrations of one's own beside reverse data, as arrays, for the same learner."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rtg


def demonstrations(task: rtg.Task, episodes: int) -> rtg.Transitions:
    """Plays a simple script: push the box that is farthest out, towards the middle."""
    box2d = rtg.forward.Box2D(task)
    states, actions, after = [], [], []
    for seed in range(episodes):
        state = task.start(seed)
        for _ in range(task.horizon):
            robot, boxes = state[0, :2], state[1:, :2]
            box = boxes[np.linalg.norm(boxes, axis=1).argmax()]
            behind = box * (1.0 + 1.6 / np.linalg.norm(box))  # outside of it, to push it inwards
            way = behind - robot if np.linalg.norm(behind - robot) > 1.2 else -box
            action = round(np.arctan2(way[1], way[0]) / (2.0 * np.pi) * task.headings)
            next_state, ok = box2d.push(state[None], [action % task.headings])
            if not ok[0]:
                break
            states.append(state)
            actions.append(action % task.headings)
            after.append(next_state[0])
            state = next_state[0]
            if task.succeeded(state[None])[0]:
                break
    before, then = np.array(states), np.array(after)
    source = np.zeros(len(before), np.int8)
    return rtg.Transitions(before, np.array(actions), then, task.succeeded(then), source)


def main(folder: Path, transitions: int = 10000, interactions: int = 30000) -> None:
    task = rtg.load_task("gathering")
    own = demonstrations(task, 30)
    print(f"{len(own)} pushes of the script, {own.success.sum()} of 30 episodes succeed")
    data = rtg.Transitions.joined([own, *rtg.generate(task, transitions, workers=2)])
    policy = rtg.train(data, task, folder / "own_data", interactions=interactions)
    print(f"success from 50 held-out starts: {policy.success_rate(50):.2f}")

    values = policy.values(own.states).max(axis=1)
    axes = plt.figure(figsize=(6, 4)).gca()
    axes.plot(values[:200])
    axes.set(xlabel="push of the script", ylabel="value of the policy", ylim=(0, None))
    axes.figure.savefig(folder / "10_own_data.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
