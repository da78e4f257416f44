"""What is drawn and said of a run at its end."""

import json
from pathlib import Path

import numpy as np
import pytest
from rtg import _core, effective_config, results, run_args
from rtg.run_plan import RunPlan


@pytest.mark.parametrize(
    ("actions", "success", "trained", "title"),
    [
        (17, True, True, "gathering: success after 17 actions (learned policy)"),
        (60, False, True, "gathering: not solved in 60 actions (learned policy)"),
        (1, True, False, "gathering: success after 1 action (generated data, no training)"),
    ],
)
def test_the_pictures_of_an_episode_say_how_it_ended_and_whose_it_is(
    actions, success, trained, title
):
    assert results.episode_title("gathering", actions, success, trained) == title


@pytest.fixture
def values(tmp_path):
    """Of a run in the folder that has learned, though it was never evaluated on the way."""
    args = run_args.parse(["gathering", "--method", "ddqn"])
    file = tmp_path / "config.yaml"
    file.write_text(effective_config.canonical(args.file, args.overrides))
    (tmp_path / "progress.csv").write_text("interactions,success_rate\n")
    (tmp_path / "training.json").write_text("{}")
    config = _core.Config.from_file(file)
    np.savez(tmp_path / "best_episode.npz", poses=config.task.start[None], success=False)
    return json.loads(config.json)


def pictures(folder):
    return {path.name for path in folder.iterdir() if path.suffix in {".png", ".gif"}}


def test_a_run_that_was_never_evaluated_ends_without_a_curve(tmp_path, values):
    """Resumed with a budget below what it had used, before the first evaluation."""
    plan = RunPlan(tmp_path, "x", values, train=True, resume=True, notes=())
    assert results.finish(plan, {})["method"] == "ddqn"
    assert pictures(tmp_path) == {"episode.png", "episode.gif"}


def test_the_episode_of_a_learner_stays_when_only_data_are_made(tmp_path, values):
    learned = (tmp_path / "best_episode.npz").read_bytes()
    plan = RunPlan(tmp_path, "x", values, train=False, resume=True, notes=())
    results.finish(plan, {})
    assert (tmp_path / "best_episode.npz").read_bytes() == learned
    assert pictures(tmp_path) == {"episode.png", "episode.gif"}


@pytest.mark.parametrize(("success", "told"), [(0.0, True), (0.05, True), (0.6, False)])
def test_data_that_does_not_connect_start_and_goal_is_told(success, told):
    plan = RunPlan(Path("runs/x"), "x", {}, train=False, resume=False, notes=())
    summary = {
        "transitions": 2000,
        "generate_wall_s": 3.0,
        "contact_share": 0.3,
        "tree_policy_success": success,
    }
    assert ("--transitions" in results.words(plan, summary)) == told


@pytest.mark.parametrize(
    ("interactions", "count", "bar", "words"),
    [
        (20000, 3, 0.95, "3 evaluations in a row had solved 95% or more"),
        (20000, 1, 0.975, "an evaluation had solved 97.5% or more"),
        (350000, 3, 0.95, None),
    ],
)
def test_an_early_end_of_training_is_explained(interactions, count, bar, words):
    train = {"interactions": 350000, "stop_at_success": bar, "stop_evaluations": count}
    plan = RunPlan(Path("runs/x"), "x", {"train": train}, train=True, resume=False, notes=())
    summary = {
        "transitions": 2000,
        "generate_wall_s": 3.0,
        "contact_share": 0.3,
        "tree_policy_success": 0.5,
        "success_rate": 0.98,
        "interactions": interactions,
        "train_wall_s": 60.0,
        "episode_length_mean": 15.0,
    }
    said = results.words(plan, summary)
    assert ("not needed" in said) == (words is not None)
    assert words is None or f"350,000 interactions were not needed: {words}" in said
