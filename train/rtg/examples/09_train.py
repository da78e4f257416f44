"""From a task to a policy: generate, train, evaluate, and look at an episode."""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import rtg


def main(folder: Path, transitions: int | None = None, interactions: int | None = None) -> None:
    task = rtg.load_task("drawer")  # of RTG's tasks the one that is learned fastest
    data = rtg.Transitions.joined(rtg.generate(task, transitions, workers=2))
    policy = rtg.train(data, task, folder / "drawer", interactions=interactions)
    print(f"success from 50 held-out starts: {policy.success_rate(50):.2f}")

    box2d, states = rtg.forward.Box2D(task), [task.start(seed=1)]
    while len(states) <= task.horizon and not task.succeeded(states[-1][None])[0]:
        after, _ = box2d.push(states[-1][None], policy(states[-1][None]))
        states.append(after[0])
    print(f"an episode of {len(states) - 1} pushes")
    frames = [Image.fromarray(task.image(np.array(states[: k + 1]))) for k in range(len(states))]
    frames[0].save(
        folder / "09_train.gif", save_all=True, append_images=frames[1:], duration=150, loop=0
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
