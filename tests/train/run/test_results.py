"""Checks what is drawn and said of a run at its end."""

import json
from pathlib import Path

import numpy as np
import pytest
from rtg import _core, cli, paths
from rtg.run import results
from rtg.run.plan import RunPlan, plan_of


@pytest.mark.parametrize(
    ("actions", "success", "title"),
    [
        (17, True, "gathering: success after 17 actions (her)"),
        (60, False, "gathering: not solved in 60 actions (her)"),
        (1, True, "gathering: success after 1 action (her)"),
    ],
)
def test_the_pictures_of_an_episode_say_how_it_ended_and_whose_it_is(actions, success, title):
    assert results.episode_title("gathering", actions, success, "her") == title


def config(*overrides):
    return _core.Config.from_file(paths.CONFIG / "gathering.yaml", overrides)


@pytest.fixture
def learned(tmp_path):
    """Makes the folder that of a run that has learned, though it was never evaluated on the way."""
    made_with = config("run.method=ddqn")
    (tmp_path / "config.yaml").write_text(made_with.yaml)
    (tmp_path / "progress.csv").write_text("interactions,success_rate\n")
    (tmp_path / "training.json").write_text("{}")
    np.savez(tmp_path / "best_episode.npz", poses=made_with.task.start[None], success=False)
    return made_with


def pictures(folder):
    return {path.name for path in folder.iterdir() if path.suffix in {".png", ".gif"}}


def test_a_run_that_was_never_evaluated_ends_without_a_curve(tmp_path, learned):
    """It is resumed with a budget below what it had used, before the first evaluation."""
    plan = RunPlan(tmp_path, "x", learned, train=True, resume=True, notes=())
    results.draw(plan)
    assert results.finish(plan, {})["method"] == "ddqn"
    assert pictures(tmp_path) == {"episode.png", "episode.gif"}


def test_the_episode_of_a_learner_stays_when_only_data_are_made(tmp_path, learned):
    before = (tmp_path / "best_episode.npz").read_bytes()
    plan = RunPlan(tmp_path, "x", learned, train=False, resume=True, notes=())
    results.draw(plan)
    results.finish(plan, {})
    assert (tmp_path / "best_episode.npz").read_bytes() == before
    assert pictures(tmp_path) == {"episode.png", "episode.gif"}


@pytest.mark.parametrize(
    ("method", "trained", "origin"),
    [
        ("ddqn_rtg", True, "learned policy"),
        ("planner", True, "forward search"),
        ("ddqn_naive", False, "plan found backwards, replayed"),
        ("ddqn_forward", False, "plan of the data, replayed"),
    ],
)
def test_an_episode_comes_from_the_learner_or_the_data(tmp_path, method, trained, origin):
    plan = RunPlan(
        tmp_path, "x", config(f"run.method={method}"), train=trained, resume=False, notes=()
    )
    assert results._origin(plan, plan.config.task.start) == origin
    if not trained:
        away = plan.config.task.start + np.array([0.0, 0.6, 0.0])
        assert results._origin(plan, away).startswith("end of a plan ")


SUMMARY = {
    "transitions": 2000,
    "generate_wall_s": 3.0,
    "contact_share": 0.3,
    "headings_per_state": 4.87,
    "trees": 3,
    "candidates": 9000,
    "pruned": 3000,
    "converged": 5000,
    "starts_reached": 2,
    "start_depth": 9.0,
    "success_rate": 0.98,
    "interactions": 20000,
    "train_wall_s": 60.0,
    "episode_length_mean": 15.0,
    "q_rank_correlation": 0.756,
}


def test_of_the_data_and_of_q_the_words_say_what_predicts_learning():
    plan = RunPlan(Path("runs/x"), "x", config("run.method=cql_rtg"), True, False, ())
    said = results.summary_text(plan, SUMMARY).splitlines()
    assert said[0] == "2,000 transitions in 3 s, contact share 0.30, 4.9 headings per state"
    assert said[2] == "rank correlation of Q with the simulator, over all headings: 0.76"
    without_rank = {**SUMMARY, "q_rank_correlation": None}
    assert len(results.summary_text(plan, without_rank).splitlines()) == 3
    torn = results.summary_text(plan, {**SUMMARY, "journal_bytes_dropped": 1200}).splitlines()
    assert "generation.journal: 1,200 bytes were torn" in torn[-2]


def test_what_falls_short_is_the_last_word_before_the_folder(tmp_path):
    plan = RunPlan(tmp_path, "x", config("run.method=ddqn_rtg"), False, False, ())
    poses = plan.config.task.start.tolist()
    report = {
        "nodes": [{"poses": poses, "depth": 3}],
        "starts": [{"poses": poses, "depth": None, "away": [1.0] * len(poses)}],
    }
    untrained = {**SUMMARY, "success_rate": None}
    for reached in (0, 2):
        found = {**untrained, "starts_reached": reached}
        (tmp_path / "generation.json").write_text(json.dumps({**found, **report}))
        last = results.summary_text(plan, found).splitlines()[-2]
        assert last.startswith("bottleneck: reaching the start") == (reached == 0)
        early = results.generation_warning(plan)
        words = "these data may not suffice, though such data often do: reaching the start: no tree"
        assert early is None if reached else early.startswith(words)


def test_goal_states_drawn_in_vain_are_told_once(tmp_path):
    plan = RunPlan(tmp_path, "x", config("run.method=ddqn_rtg"), False, False, ())
    draws = {"goal_draws": 50, "undrawn_goals": 20, "undrawn_reason": "the robot found no place"}
    solved = {**SUMMARY, **draws}
    (tmp_path / "generation.json").write_text(json.dumps({**solved, "nodes": []}))
    words = "goal states: 20 of 50 draws met no goal: the robot found no place; "
    assert words in results.summary_text(plan, solved)
    assert words in results.generation_warning(plan)
    rootless = {**solved, "trees": 0, "success_rate": 0.1}
    (tmp_path / "generation.json").write_text(json.dumps(rootless))
    said = results.summary_text(plan, rootless)
    assert said.count("goal states") == 1 and "(the robot found no place)" in said


@pytest.mark.parametrize(
    ("interactions", "count", "bar", "words"),
    [
        (20000, 3, 0.95, "3 evaluations in a row had solved 95% or more"),
        (20000, 1, 0.975, "an evaluation had solved 97.5% or more"),
        (350000, 3, 0.95, None),
    ],
)
def test_an_early_end_of_training_is_explained(interactions, count, bar, words):
    stops = config(f"train.stop_at_success={bar}", f"train.stop_evaluations={count}")
    plan = RunPlan(Path("runs/x"), "x", stops, train=True, resume=False, notes=())
    said = results.summary_text(plan, {**SUMMARY, "interactions": interactions})
    assert ("not needed" in said) == (words is not None)
    assert words is None or f"330,000 of 350,000 interactions were not needed: {words}" in said


def test_learning_without_interactions_did_not_end_early_for_want_of_them():
    plan = RunPlan(
        Path("runs/x"), "x", config("run.method=cql_rtg"), train=True, resume=False, notes=()
    )
    assert "not needed" not in results.summary_text(plan, {**SUMMARY, "interactions": 0})


def test_the_rest_of_the_wall_time_is_a_stage_of_its_own() -> None:
    solves, acting = {"wall_s": 2.0, "cpu_s": 4.0}, {"wall_s": 3.0, "cpu_s": 1.0}
    generation = {"generation_stages": {"solves": solves}, "generate_wall_s": 2.5}
    learning = {"learning_stages": {"acting": acting}, "train_wall_s": 2.9}  # rounded
    parts = {
        "generation": {"solves": solves, "bookkeeping": {"wall_s": 0.5}},
        "learning": {"acting": acting, "other": {"wall_s": 0.0}},
    }
    assert results.stage_times({**generation, **learning}) == parts
    assert results.stage_times(generation) == {"generation": parts["generation"]}
    assert results.stage_times({"train_wall_s": 3.0}) == {}  # of the planner
    assert results.stage_times({"start_wall_s": 1.5}) == {"run": {"start": {"wall_s": 1.5}}}


def test_the_times_of_the_stages_are_drawn(tmp_path, learned) -> None:
    acting = {"acting": {"wall_s": 3.0, "cpu_s": 1.0}}
    figures = {"learning_stages": acting, "train_wall_s": 4.0}
    (tmp_path / "training.json").write_text(json.dumps(figures))
    plan = RunPlan(tmp_path, "x", learned, train=True, resume=True, notes=())
    results.draw(plan)
    results.finish(plan, {})
    assert pictures(tmp_path) == {"episode.png", "episode.gif", "stages.png"}


def test_the_pictures_of_a_finished_run_are_drawn_again(tmp_path, learned, capsys) -> None:
    assert cli.main(["plot", str(tmp_path)]) == 2
    assert f"{tmp_path}: has no summary.json; legal: " in capsys.readouterr().err
    acting = {"acting": {"wall_s": 3.0, "cpu_s": 1.0}}
    (tmp_path / "training.json").write_text(
        json.dumps({"learning_stages": acting, "train_wall_s": 4.0})
    )
    results.finish(plan_of(tmp_path), {})
    (tmp_path / "stages.png").unlink()
    assert cli.main(["plot", str(tmp_path), "--format", "pdf"]) == 0
    for name in ("stages.pdf", "episode.pdf"):
        assert (tmp_path / name).read_bytes().startswith(b"%PDF")
    assert pictures(tmp_path) == {"episode.gif"}
