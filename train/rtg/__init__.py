"""Reverse trajectory generation: processes, learning and tools around the C++ core."""

from gymnasium.envs.registration import register

from rtg import processor

processor.check()  # before the core is loaded

from rtg import engines, forward
from rtg.beam_search import BeamSearch, Nodes
from rtg.energy import Contact, StepEnergy
from rtg.policy import Policy, load_policy, train
from rtg.reverse import Contacts, ReverseSimulator, ReverseSolutions
from rtg.task import Task, load_task
from rtg.transitions import SOURCES, Transitions, generate

__all__ = [
    "ENVIRONMENTS",
    "SOURCES",
    "BeamSearch",
    "Contact",
    "Contacts",
    "Nodes",
    "Policy",
    "ReverseSimulator",
    "ReverseSolutions",
    "StepEnergy",
    "Task",
    "Transitions",
    "engines",
    "forward",
    "generate",
    "load_policy",
    "load_task",
    "train",
]

# Gymnasium's ids: the task of each, and its horizon, after which `gymnasium.make` ends episodes.
ENVIRONMENTS = {
    "RTG/Gathering-v0": ("gathering", 60),
    "RTG/GatheringHard-v0": ("gathering_hard", 60),
    "RTG/Sorting-v0": ("sorting", 60),
    "RTG/SortingHard-v0": ("sorting_hard", 60),
    "RTG/ArtManip-v0": ("art_manip", 60),
    "RTG/ArtManipHard-v0": ("art_manip_hard", 60),
    "RTG/PushT-v0": ("push_t", 100),
    "RTG/PushTHard-v0": ("push_t_hard", 100),
    "RTG/Place-v0": ("place", 100),
    "RTG/Insert-v0": ("insert", 80),
    "RTG/Key-v0": ("key", 80),
    "RTG/Plug-v0": ("plug", 80),
    "RTG/Pack-v0": ("pack", 60),
    "RTG/Gate-v0": ("gate", 80),
    "RTG/Maze-v0": ("maze", 80),
    "RTG/Drawer-v0": ("drawer", 80),
    "RTG/Cable-v0": ("cable", 80),
}


def _register(id: str, horizon: int | None, **kwargs: str | bool | None) -> None:
    register(
        id,
        "rtg.envs.push_env:PushEnv",
        vector_entry_point="rtg.envs.push_vector_env:PushVectorEnv",
        max_episode_steps=horizon,
        kwargs=kwargs,
    )


for _id, (_task, _horizon) in ENVIRONMENTS.items():
    _register(_id, _horizon, config=_task, ends_at_horizon=False)
_register("RTG/Task-v0", None, config=None)  # any task, which the user names; its horizon holds
