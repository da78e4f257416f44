"""Windows and videos of episodes."""

import copy
import pickle
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.error import DependencyNotInstalled
from gymnasium.wrappers import RecordVideo
from rtg.envs import window
from rtg.envs.push_env import PushEnv


def test_a_window_shows_each_state(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pygame", reason="there is no wheel for this version of Python")
    shown: list[np.ndarray] = []

    class Shown(window.Window):
        def show(self, picture: np.ndarray, fps: float) -> None:
            super().show(picture, 1000.0)
            surface = self._pygame.surfarray.array3d(self._surface)
            np.testing.assert_array_equal(surface.transpose(1, 0, 2), picture)
            shown.append(picture)

    monkeypatch.setattr("rtg.envs.push_env.Window", Shown)
    env = PushEnv(render_mode="human")
    env.reset(seed=1)
    env.step(0)
    assert len(shown) == 2 and not np.array_equal(shown[0], shown[1])
    assert env.render() is None
    again = pickle.loads(pickle.dumps(env))
    np.testing.assert_array_equal(again.step(3)[0], copy.deepcopy(env).step(3)[0])
    for one in (env, again):
        one.close()
        one.close()


def test_a_window_without_pygame_is_an_error_that_names_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pygame", None)
    with pytest.raises(DependencyNotInstalled, match=r"needs pygame: pip install '.*\[human\]'"):
        PushEnv(render_mode="human").reset()


def test_videos_are_recorded(tmp_path: Path) -> None:
    films = tmp_path / "films"
    env = RecordVideo(gymnasium.make("RTG/Gathering-v0", render_mode="rgb_array"), str(films))
    env.reset(seed=1)
    for action in range(3):
        env.step(action)
    env.close()
    (film,) = films.glob("*.mp4")
    assert film.stat().st_size > 2000


def test_a_drawn_goal_is_where_its_outlines_are_drawn() -> None:
    env = PushEnv(goals="drawn", render_mode="rgb_array")
    env.reset(seed=1)
    goal = env.get_state()["goal"]
    x, y = goal[1, :2]
    frame = env.render()
    half = 1.06 * env.task.arena
    column, row = int((x + half) / (2 * half) * 360), int((half - y) / (2 * half) * 360)
    paper = np.array(frame[2, 180])
    assert np.abs(frame[row, column].astype(int) - paper).max() > 10
    plain = PushEnv(render_mode="rgb_array")
    plain.reset(options={"poses": env.poses})
    assert not np.array_equal(plain.render(), frame)
