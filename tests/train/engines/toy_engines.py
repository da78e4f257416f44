"""Forward simulators of a user: forward.engine toy_engines:CLASS."""

import numpy as np
from rtg.engines import Scene
from rtg.errors import RunError


class Ghost:
    """The robot goes through everything."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        ends = states.copy()
        ends[:, 0, :2] += ways
        return ends, np.ones(len(states), bool)


class Versioned(Ghost):
    version = "1.2"


class NoText(Ghost):
    version = 12


class TwoLines(Ghost):
    version = "1\n2"


class Finicky(Ghost):
    """Cannot simulate pushes to the left."""

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return super().push(states, ways)[0], ways[:, 0] >= 0.0


class Broken(Ghost):
    """Fails for states whose robot is right of 1 m."""

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if (states[:, 0, 0] > 1.0).any():
            raise ZeroDivisionError("no such place")
        return super().push(states, ways)


class BrokenTogether(Ghost):
    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if len(states) > 1:
            raise MemoryError("too many")
        return super().push(states, ways)


class Short(Ghost):
    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return states[:, :1], np.ones(len(states), bool)


class Lost(Ghost):
    """Loses the robot, and says that all is well."""

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        ends, ok = super().push(states, ways)
        return np.where(np.arange(states.shape[1])[:, None] == 0, np.nan, ends), ok


class Wind(Ghost):
    """Blows at walls, too."""

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return states + 0.01, np.ones(len(states), bool)


class Drifting(Ghost):
    """Moves all by less than rounding might, and turns them around."""

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return states + np.array([3e-6, 0.0, 2.0 * np.pi]), np.ones(len(states), bool)


class Leaving(Ghost):
    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        raise SystemExit("no licence")


class Ours(Ghost):
    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        raise RunError("no licence")


class Helpless(Ghost):
    """Cannot simulate any push."""

    def push(self, states: np.ndarray, ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return states, np.zeros(len(states), bool)


class Unmade(Ghost):
    def __init__(self, scene: Scene) -> None:
        raise RuntimeError("no licence")


class NoEngine:
    pass
