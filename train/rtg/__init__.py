"""Reverse trajectory generation: processes, learning and tools around the C++ core."""

from gymnasium.envs.registration import register

register(id="RTG/Gathering-v0", entry_point="rtg.env:PushEnv")
