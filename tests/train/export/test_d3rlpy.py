"""An exported data set in another library: d3rlpy learns from it."""

import numpy as np
import pytest
from exported import run_folder
from rtg.export import minari_format, run_data

minari = pytest.importorskip("minari", reason="the extra `minari` is not installed")
d3rlpy = pytest.importorskip("d3rlpy", reason="d3rlpy is not installed")


def test_its_offline_learner_takes_the_episodes(tmp_path):
    data = run_data.read(run_folder(tmp_path / "run"))
    minari_format.write(data, "plans", "mine-v0", tmp_path, 50)
    found = minari.MinariDataset(tmp_path / "mine-v0" / "data")
    episodes = list(found.iterate_episodes())
    buffer = d3rlpy.dataset.MDPDataset(
        np.concatenate([episode.observations[:-1] for episode in episodes]),
        np.concatenate([episode.actions for episode in episodes]),
        np.concatenate([episode.rewards for episode in episodes]),
        np.concatenate([episode.terminations for episode in episodes]),
        np.concatenate([episode.truncations for episode in episodes]),
        action_space=d3rlpy.ActionSpace.DISCRETE,
        action_size=int(found.action_space.n),
    )
    cut = sum(bool(episode.truncations[-1]) for episode in episodes)
    assert buffer.transition_count == found.total_steps - cut  # it drops the last step of those
    learner = d3rlpy.algos.DiscreteCQLConfig(batch_size=8).create()
    learner.build_with_dataset(buffer)
    assert np.isfinite(learner.update(buffer.sample_transition_batch(8))["loss"])
    assert 0 <= int(learner.predict(episodes[0].observations[:1])[0]) < 48
