"""Vector environments for Stable-Baselines3, which has an interface of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium import Env
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv
from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvObs, VecEnvStepReturn

from rtg.envs.push_vector_env import PushVectorEnv

# Names of PushVectorEnv: its attributes that are arrays have one entry per environment.
_OF_ONE = {  # and what one of them has in their place
    "observation_space": "single_observation_space",
    "action_space": "single_action_space",
}
_OF_EACH = ("observation", "render")  # methods with one result per environment
_OF_ALL = ("reset", "step", "begin", "close")  # those that change all environments at once


class PushVecEnv(VecEnv):
    """A PushVectorEnv as Stable-Baselines3 takes it. A new episode begins where one has ended.

    `infos` have the entries of PushEnv, and "terminal_observation" and "TimeLimit.truncated" where
    an episode has ended.
    """

    def __init__(self, num_envs: int, config: Any = "gathering", **kwargs: Any) -> None:
        """`kwargs`: those of PushVectorEnv."""
        self.envs = PushVectorEnv(num_envs, config, **kwargs)
        super().__init__(
            num_envs, self.envs.single_observation_space, self.envs.single_action_space
        )
        self._actions: NDArray[Any] = np.zeros(0)

    def reset(self) -> VecEnvObs:
        observation, info = self.envs.reset(seed=self._seeds[0])
        self._reset_seeds()
        self.reset_infos = self._infos(info)
        return observation

    def set_options(self, options: list[dict[str, Any]] | dict[str, Any] | None = None) -> None:
        """Raises ValueError for options, of which there are none."""
        if options:
            raise ValueError(f"unknown options {options}; legal: none")

    def step_async(self, actions: NDArray[Any]) -> None:
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        seen, reward, terminated, truncated, info = self.envs.step(self._actions)
        done = terminated | truncated
        infos = self._infos(info)
        for env in map(int, np.flatnonzero(done)):
            infos[env]["terminal_observation"] = _entry(seen, env)
            infos[env]["TimeLimit.truncated"] = bool(truncated[env])
        if done.any():
            self.envs.begin(done)
            seen = self.envs.observation()
        return seen, reward.astype(np.float32), done, infos

    def _infos(self, info: dict[str, Any]) -> list[dict[str, Any]]:
        return [{key: value[env] for key, value in info.items()} for env in range(self.num_envs)]

    def close(self) -> None:
        self.envs.close()

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        return self.envs.render() or [None] * self.num_envs

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """Returns an attribute of each environment; one that all share as often as asked for."""
        value = getattr(self.envs, _OF_ONE.get(attr_name, attr_name))
        is_of_each = isinstance(value, np.ndarray)
        return [value[env] if is_of_each else value for env in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Sets an attribute of all environments. Raises ValueError for some of them."""
        if len(list(self._get_indices(indices))) != self.num_envs:
            raise ValueError(f"'{attr_name}' of some environments; legal: of all, indices=None")
        setattr(self.envs, attr_name, value)

    def env_method(
        self, method_name: str, *args: Any, indices: VecEnvIndices = None, **kwargs: Any
    ) -> list[Any]:
        """Calls a method of the environments once, and returns what each of `indices` has of it.

        Methods that are not about the current states, such as compute_reward(), return the same for
        each. Raises ValueError for those that go on with episodes.
        """
        if method_name in _OF_ALL:
            raise ValueError(f"method '{method_name}'; legal: reset() and step() of this object")
        value = getattr(self.envs, method_name)(*args, **kwargs)
        is_of_each = method_name in _OF_EACH and value is not None
        return [_entry(value, env) if is_of_each else value for env in self._get_indices(indices)]

    def env_is_wrapped(
        self, wrapper_class: type[Env[Any, Any]], indices: VecEnvIndices = None
    ) -> list[bool]:
        return [False for _ in self._get_indices(indices)]


def _entry(observations: Any, env: int) -> Any:
    if isinstance(observations, dict):
        return {key: values[env] for key, values in observations.items()}
    return observations[env]
