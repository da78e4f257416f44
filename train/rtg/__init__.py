"""Reverse trajectory generation: processes, learning and tools around the C++ core."""

from gymnasium.envs.registration import register

from rtg import paths

ENVIRONMENTS = {
    "RTG/Gathering-v0": "gathering",
    "RTG/GatheringHard-v0": "gathering_hard",
    "RTG/Sorting-v0": "sorting",
    "RTG/SortingHard-v0": "sorting_hard",
    "RTG/ArtManip-v0": "art_manip",
}

for _id, _task in ENVIRONMENTS.items():
    register(_id, "rtg.envs.push_env:PushEnv", kwargs={"config": paths.CONFIG / f"{_task}.yaml"})
