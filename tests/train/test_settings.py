import json

from rtg import _core, paths
from rtg.settings import TrainSettings


def settings(*overrides: str) -> TrainSettings:
    text = f"task: {paths.CONFIG / 'gathering.yaml'}"
    config = _core.Config.from_text(text, overrides=overrides)
    return TrainSettings.from_config(json.loads(config.json)["train"])


def test_python_and_cpp_have_the_same_defaults() -> None:
    assert settings() == TrainSettings()


def test_the_preset_paper_is_these_values() -> None:
    """None of what the default departs by."""
    assert settings("train.preset=paper") == TrainSettings(
        preset="paper",
        batch=512,
        learning_rate=5e-5,
        target_sync=2500,
        target_rate=1.0,
        target_acts=False,
        policy_rate=1.0,
        discount=0.0,
        offline_share=-1.0,
        recent_share=0.0,
        cautious=False,
        dueling=False,
        layer_norm=False,
        small_head=False,
        clip_targets=False,
        value_bounds=False,
        epsilon_start=1.0,
        epsilon_end=0.05,
        epsilon_share=0.1,
        nearby_share=0.0,
        leave_loops=False,
        start_jitter=0.0,
        eval_every=10_000,
        stop_at_success=0.0,
        reduced_precision=False,
    )


def test_the_preset_paper_is_table_2_with_the_defaults_of_sb3() -> None:
    paper = settings("train.preset=paper")
    table_2 = (paper.interactions, paper.buffer, paper.batch, paper.learning_rate)
    assert table_2 == (350_000, 1_500_000, 512, 5e-5)
    assert (paper.train_frequency, paper.gradient_steps) == (4, 1)
    assert (paper.target_sync * paper.train_frequency, paper.target_rate) == (10_000, 1.0)
    assert paper.offline_share < 0 and paper.stop_at_success == 0 and paper.policy_rate == 1
    assert (paper.epsilon_start, paper.epsilon_end, paper.epsilon_share) == (1.0, 0.05, 0.1)
