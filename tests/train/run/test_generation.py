"""The generation inside of the Python process."""

import json

import numpy as np
import pytest
from rtg import _core, paths
from rtg.files import run_folder

FILE = paths.CONFIG / "tests" / "tiny.yaml"


def generated(*overrides: str) -> tuple[list[np.ndarray], list[dict], dict]:
    config = _core.Config.from_file(FILE, overrides)
    batches, lines = [], []
    report = _core.generate(config, lambda *columns: batches.append(columns), lines.append)
    columns = [np.concatenate(parts) for parts in zip(*batches, strict=True)]
    return columns, lines, json.loads(report)


def test_transitions_are_true_and_as_many_as_asked() -> None:
    (poses, action, after, success, source), lines, report = generated()
    config = _core.Config.from_file(FILE)
    assert len(action) == report["transitions"] == 2000
    replayed, ok = _core.Simulator(config).push(poses, action.astype(np.int64))
    assert ok.all()
    np.testing.assert_array_equal(replayed, after)
    np.testing.assert_array_equal(config.task.succeeded(after), success)
    assert success.any() and set(source) == {0, 1}
    assert lines[-1]["transitions"] == lines[-1]["target"] == 2000


@pytest.mark.parametrize("engine", ["box2d", "newton"])
def test_the_engine_asked_for_is_that_of_replays_and_environments(engine: str) -> None:
    config = _core.Config.from_file(FILE, [f"forward.engine={engine}", "search.transitions=300"])
    other = _core.Config.from_file(FILE, ["forward.engine=newton"] if engine == "box2d" else [])
    batches: list[tuple] = []
    _core.generate(config, lambda *columns: batches.append(columns), lambda progress: None)
    poses, action, after = (np.concatenate(part) for part in list(zip(*batches, strict=True))[:3])
    replayed, ok = _core.Simulator(config).push(poses, action.astype(np.int64))
    assert ok.all()
    np.testing.assert_array_equal(replayed, after)
    elsewhere, _ = _core.Simulator(other).push(poses, action.astype(np.int64))
    assert (elsewhere != after).any()


def test_the_report_of_the_search_itself_has_every_figure_of_the_summary(tmp_path) -> None:
    """So a run that is stopped between the last transition and its end lacks none of them."""
    _, _, report = generated()
    run_folder.write_json(tmp_path / "generation.json", report)
    config = _core.Config.from_file(FILE)
    summary = run_folder.summary(tmp_path, config, "lcm", {})
    of_the_learner = {"train_wall_s", "interactions", "online_successes", "success_rate"}
    of_the_learner |= {"episode_length_mean", "episode_return_mean", "train_cpu_s"}
    of_the_learner |= {"q_rank_correlation", "q_error", "q_spread"}
    unknown = {key for key in run_folder.SUMMARY_KEYS if summary[key] is None}
    assert unknown == of_the_learner | {"start_depth"}  # no tree of so few transitions gets there
    assert summary["generate_wall_s"] > 0


def test_the_seed_decides_and_the_number_of_threads_does_not() -> None:
    first, again = generated("run.workers=1"), generated("run.workers=3")
    for a, b in zip(first[0], again[0], strict=True):
        np.testing.assert_array_equal(a, b)
    other = generated("run.seed=2")
    assert not np.array_equal(first[0][0], other[0][0])


def test_an_exception_of_a_callback_ends_the_generation() -> None:
    def interrupt(line: dict) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        _core.generate(_core.Config.from_file(FILE), lambda *columns: None, interrupt)


def test_mistakes_in_the_configuration_are_value_errors_with_the_place() -> None:
    with pytest.raises(_core.ConfigError, match=r"tiny.yaml:1: key 'task'"):
        _core.Config.from_text("search: {}\n", "tiny.yaml")
    with pytest.raises(ValueError, match=r"--set search.breadth=0: key 'search.breadth'"):
        _core.Config.from_file(FILE, ["search.breadth=0"])


def test_the_canonical_text_reads_back_to_the_same() -> None:
    config = _core.Config.from_file(FILE, ["run.seed=5"])
    again = _core.Config.from_text(config.yaml)
    assert again.yaml == config.yaml and again.json == config.json
    assert json.loads(again.json)["run"]["seed"] == 5
