"""The data in a learner of one's own: Q-learning from transitions alone, in plain PyTorch."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import torch

import rtg


def main(folder: Path, transitions: int = 20000, steps: int = 3000) -> None:
    task = rtg.load_task("gathering")
    data = rtg.Transitions.joined(rtg.generate(task, transitions, workers=2))
    seen = torch.from_numpy(task.observation(data.states))
    after = torch.from_numpy(task.observation(data.next_states))
    action = torch.from_numpy(data.actions)[:, None]
    reward = torch.from_numpy(data.success).float()[:, None]  # success ends an episode

    torch.manual_seed(0)

    def network() -> torch.nn.Sequential:
        return torch.nn.Sequential(
            torch.nn.Linear(seen.shape[1], 256),
            torch.nn.ReLU(),
            torch.nn.Linear(256, 256),
            torch.nn.ReLU(),
            torch.nn.Linear(256, task.actions),
        )

    online, target = network(), network()
    target.load_state_dict(online.state_dict())
    optimizer = torch.optim.Adam(online.parameters(), lr=5e-4)
    losses = []
    for step in range(steps):
        rows = torch.randint(len(action), (128,))
        with torch.no_grad():
            best = online(after[rows]).argmax(dim=1, keepdim=True)
            value = target(after[rows]).gather(1, best)
            goal = (reward[rows] + 0.95 * (1.0 - reward[rows]) * value).clamp(0.0, 1.0)
        loss = torch.nn.functional.smooth_l1_loss(online(seen[rows]).gather(1, action[rows]), goal)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        losses.append(loss.item())
        if step % 200 == 0:
            target.load_state_dict(online.state_dict())

    # In the simulator: how often it solves states one push from the goal. `rtg.train` has more:
    # interactions, bounds that stored plans prove, a network whose headings share weights.
    near = data.states[np.flatnonzero(data.success & (data.source == 0))][:200]
    with torch.no_grad():
        chosen = online(torch.from_numpy(task.observation(near))).argmax(dim=1).numpy()
    reached, _ = rtg.forward.Box2D(task).push(near, chosen)
    print(f"one push from the goal it succeeds in {task.succeeded(reached).mean():.0%} of states")

    axes = plt.figure(figsize=(6, 4)).gca()
    axes.semilogy(np.convolve(losses, np.ones(50) / 50, mode="valid"))
    axes.set(xlabel="gradient step", ylabel="loss, mean of 50")
    axes.figure.savefig(folder / "08_own_learner.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
