"""Reverse trajectory generation: processes, learning and tools around the C++ core."""

from gymnasium.envs.registration import register

from rtg import forward, paths
from rtg.policy import Policy, load_policy, train
from rtg.reverse import Contacts, ReverseSimulator, ReverseSolutions
from rtg.task import Task, load_task
from rtg.transitions import SOURCES, Transitions, generate

__all__ = [
    "ENVIRONMENTS",
    "SOURCES",
    "Contacts",
    "Policy",
    "ReverseSimulator",
    "ReverseSolutions",
    "Task",
    "Transitions",
    "forward",
    "generate",
    "load_policy",
    "load_task",
    "train",
]

ENVIRONMENTS = {
    "RTG/Gathering-v0": "gathering",
    "RTG/GatheringHard-v0": "gathering_hard",
    "RTG/Sorting-v0": "sorting",
    "RTG/SortingHard-v0": "sorting_hard",
    "RTG/ArtManip-v0": "art_manip",
    "RTG/PushT-v0": "push_t",
    "RTG/PushTHard-v0": "push_t_hard",
    "RTG/Place-v0": "place",
    "RTG/Insert-v0": "insert",
    "RTG/Pack-v0": "pack",
    "RTG/Gate-v0": "gate",
    "RTG/Maze-v0": "maze",
    "RTG/Drawer-v0": "drawer",
}

for _id, _task in ENVIRONMENTS.items():
    register(_id, "rtg.envs.push_env:PushEnv", kwargs={"config": paths.CONFIG / f"{_task}.yaml"})
