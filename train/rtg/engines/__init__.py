"""Forward simulators: what a run takes for the true dynamics, `forward.engine`."""

from rtg.engines.engine import Engine, EngineError, replay_function, simulator
from rtg.engines.scene import Body, Joint, Part, Scene

__all__ = [
    "Body",
    "Engine",
    "EngineError",
    "Joint",
    "Part",
    "Scene",
    "replay_function",
    "simulator",
]
