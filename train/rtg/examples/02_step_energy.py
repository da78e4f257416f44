"""The step energy, whose minimum is the motion of a sub-step, and its derivatives."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rtg


def main(folder: Path) -> None:
    task = rtg.load_task("pack")
    energy = rtg.StepEnergy(task)
    now = task.goal_state(seed=2)  # three boxes in a row: small gaps, large forces
    gaps = energy.gaps(now)
    near = energy.contacts[int(gaps.argmin())]
    print(f"{len(gaps)} contacts; the nearest, {near.body} at {near.other}: {gaps.min():.3f} m")

    # Along the x axis of the middle box, the forces of its neighbours rise against the motion.
    body = task.bodies.index("b")
    shifts = np.linspace(-0.02, 0.02, 201)
    states = np.repeat(now[None], len(shifts), axis=0)
    states[:, body, 0] += shifts
    values = np.array([energy.value(state, now) for state in states])
    slopes = np.array([energy.gradient(state, now)[3 * body] for state in states])
    differences = np.gradient(values, shifts)

    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(6, 6), layout="constrained")
    above.plot(shifts, values)
    above.set_ylabel("energy [kg m²]")
    above.locator_params(nbins=5)
    below.plot(shifts, slopes, lw=4, label="gradient()")
    below.plot(shifts, differences, lw=1, label="differences of value()")
    below.set(xlabel="shift of b in x [m]", ylabel="slope [kg m]")
    below.legend()
    figure.savefig(folder / "02_step_energy.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
