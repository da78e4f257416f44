"""A Gymnasium environment with `set_state` as a forward simulator: here, one of RTG's own.

forward.engine: rtg.examples.environment_engine:Environment
"""

import gymnasium
import numpy as np

import rtg


class Environment:
    def __init__(self, scene: rtg.engines.Scene) -> None:
        self.stride = scene.stride  # actions are ways in units of the longest stride
        self.env = gymnasium.make("RTG/Gathering-v0", actions="continuous").unwrapped
        self.env.reset()

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        ends, ok = states.copy(), np.ones(len(states), bool)
        for k in np.flatnonzero(ways.any(1)):  # without a way it is at rest, as after each step
            try:
                self.env.set_state({**self.env.get_state(), "poses": states[k], "steps": 0})
            except ValueError:  # such as bodies that overlap
                ok[k] = False
                continue
            ok[k] = not self.env.step(np.float32(ways[k] / self.stride))[4]["rejected"]
            ends[k] = self.env.get_state()["poses"]
        return ends, ok
