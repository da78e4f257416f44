"""Which states the player shows, and when."""

import numpy as np
import pytest
from rtg.view.player import Player, frames
from view_runs import TASK, episode


class Screen:
    def __init__(self):
        self.times, self.states, self.words = [], [], []
        self.player = Player(TASK, 1.0, self.show, lambda at, words: self.words.append((at, words)))

    def show(self, times, states):
        self.times += times.tolist()
        self.states += list(states)


@pytest.fixture
def screen():
    return Screen()


def test_four_frames_of_each_push_end_in_its_last_state():
    states = episode()
    shown = frames(TASK, states)
    assert len(shown) == 4 * (len(states) - 1) + 1
    assert np.allclose(shown[::4], states)
    assert shown[1, 0, 0] == pytest.approx(states[0, 0, 0] + 0.25)


def test_frames_are_shown_as_time_goes_on(screen):
    screen.player.offer(episode(), "a")
    screen.player.advance(10.0)
    assert screen.times == [10.0]
    screen.player.advance(10.6)
    assert screen.times == [10.0, 10.25, 10.5]
    screen.player.advance(np.inf)
    assert len(screen.times) == 13 and screen.times[-1] == 13.0
    assert np.allclose(screen.states[-1], episode()[-1])


def test_of_the_episodes_offered_meanwhile_the_last_one_plays_next(screen):
    screen.player.offer(episode(), "a")
    screen.player.advance(0.0)
    screen.player.offer(episode(), "b")
    screen.player.offer(episode(), "c")
    screen.player.advance(4.9)  # in the rest after the first
    assert screen.words == [(0.0, "a")]
    screen.player.advance(7.0)
    assert screen.words == [(0.0, "a"), (7.0, "c")]
    screen.player.offer(episode(), "d")
    screen.player.advance(np.inf)
    assert screen.words[-1] == (12.0, "d")  # when the one before has ended and rested
