"""Your own forward simulator in the place of Box2D: pymunk, by the class in pymunk_engine.py."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rtg

ENGINE = "forward.engine=rtg.examples.pymunk_engine:Pymunk"


def main(folder: Path, transitions: int = 2000) -> None:
    task = rtg.load_task("gathering", [ENGINE])
    data = rtg.Transitions.joined(rtg.generate(task, transitions))
    print(f"{len(data)} transitions of pymunk, {data.success.sum()} of them reach the goal")

    again, _ = rtg.forward.Forward(task).push(data.states, data.actions)
    print(f"simulated again, they differ by {np.abs(again - data.next_states).max():.1e} m at most")
    others = {"Box2D": rtg.forward.Box2D(task), "the reverse model": rtg.forward.Newton(task)}
    axes = plt.figure(figsize=(7, 4), layout="constrained").gca()
    moved = np.abs(data.next_states - data.states)[:, 1:, :2].max((1, 2)) > 0.05
    for name, engine in others.items():
        ends, _ = engine.push(data.states[moved], data.actions[moved])
        away = np.linalg.norm((ends - data.next_states[moved])[:, 1:, :2], axis=2).max(1)
        axes.hist(
            away, np.linspace(0.0, 0.5, 50), alpha=0.6, label=f"{name}: {np.median(away):.3f} m"
        )
    axes.set(xlabel="distance of the object that differs most [m]", ylabel="pushes that move one")
    axes.legend(title="ends of pushes, pymunk against: median")
    axes.figure.savefig(folder / "11_own_engine.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
