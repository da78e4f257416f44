"""The Gymnasium environment: episodes, a state to come back to, and many side by side."""

import sys
from pathlib import Path

import gymnasium
import numpy as np
from PIL import Image

import rtg  # registers the environments


def main(folder: Path) -> None:
    env = gymnasium.make("RTG/PushT-v0", render_mode="rgb_array")
    observation, _ = env.reset(seed=1)
    rng = np.random.default_rng(1)
    frames, total = [Image.fromarray(env.render())], 0.0
    for step in range(30):
        observation, reward, terminated, truncated, _ = env.step(int(rng.integers(48)))
        frames.append(Image.fromarray(env.render()))
        total += float(reward)
        if step == 0:
            left = env.unwrapped.get_state()
        if terminated or truncated:
            break
    print(f"{len(frames) - 1} random pushes, reward {total}, {len(observation)} entries")
    env.unwrapped.set_state(left)  # to the bit, with the number of pushes so far
    frames[0].save(folder / "07_gymnasium.gif", save_all=True, append_images=frames[1:])

    many = gymnasium.make_vec("RTG/PushT-v0", num_envs=64)  # one call of the core steps them all
    many.reset(seed=1)
    for _ in range(20):
        many.step(rng.integers(48, size=64))
    print(f"all ids: {', '.join(rtg.ENVIRONMENTS)}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
