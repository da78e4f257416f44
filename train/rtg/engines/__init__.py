"""Forward simulators: what a run takes for the true dynamics, `forward.engine`."""

from rtg.engines.engine import (
    ENGINES,
    Engine,
    EngineError,
    Replay,
    identity,
    replay_function,
    simulator,
)
from rtg.engines.scene import Body, Joint, Part, Scene

__all__ = [
    "ENGINES",
    "Body",
    "Engine",
    "EngineError",
    "Joint",
    "Part",
    "Replay",
    "Scene",
    "identity",
    "replay_function",
    "simulator",
]
