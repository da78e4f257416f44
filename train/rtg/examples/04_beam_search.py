"""The beam search backwards in time, layer by layer: from goal states towards a start."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import rtg


def main(folder: Path) -> None:
    task = rtg.load_task("gathering")
    search = rtg.BeamSearch(task, seed=1, settings=["search.breadth=30"])
    left = [search.start_distance]
    while len(search.beam) and search.start_distance > 0.0 and len(left) <= 20:
        data = search.grow()
        left.append(search.start_distance)
        print(f"layer {len(left) - 1}: {len(data)} transitions, about {left[-1]:.0f} pushes left")

    nodes = search.nodes
    figure, (way, tree) = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
    way.plot(left, "o-")
    way.set(xlabel="layer", ylabel="pushes between the beam and the start, estimated")
    tree.set(
        aspect="equal", xlabel="x [m]", ylabel="y [m]", title="box1 in the nodes; star: its start"
    )
    for area in task.goal:
        tree.fill(*area.ring.T, color="green", alpha=0.15)
    points = tree.scatter(*nodes.states[:, 1, :2].T, c=nodes.depths, s=8)
    tree.plot(*search.target[1, :2], "r*", ms=14)
    figure.colorbar(points, label="pushes until the goal")
    figure.savefig(folder / "04_beam_search.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
