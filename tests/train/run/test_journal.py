"""A generation that was killed goes on from its journal to the same transitions."""

import io
import json
import random

import numpy as np
import pytest
from rtg import _core, paths
from rtg.errors import RunError
from rtg.files import run_folder
from rtg.files.recorder import Recorder
from rtg.run import in_process, run
from rtg.run.plan import make_plan
from rtg.run.progress import display
from rtg.run.run_args import parse

TINY = paths.CONFIG / "tests" / "tiny.yaml"
LONG = ["search.transitions=9000"]


class KilledError(Exception):
    pass


def generated(journal=None, kill_at=-1, settings=LONG):
    """Generates all columns, or until line `kill_at` of the progress; also returns the report."""
    config = _core.Config.from_file(TINY, settings)
    batches, lines = [], []

    def progress(line):
        if len(lines) == kill_at:
            raise KilledError
        lines.append(line)

    report = _core.generate(config, lambda *columns: batches.append(columns), progress, journal)
    columns = [np.concatenate(parts) for parts in zip(*batches, strict=True)]
    return columns, json.loads(report), len(lines)


def without_times(report):
    gone = (
        "generation_stages",
        "units_from_journal",
        "journal_bytes_dropped",
        "reverse_cpu_s",
        "replay_cpu_s",
    )
    gone += ("generate_cpu_s", "generate_wall_s")
    return {
        k: v for k, v in report.items() if not k.endswith(("cpu_s", "wall_s")) and k not in gone
    }


@pytest.mark.parametrize("generator", ["naive", "rrbs", "forward", "random"])
def test_a_generation_interrupted_at_twenty_points_finds_the_same(tmp_path, generator):
    few = {"rrbs": 300, "forward": 1500}.get(generator, 9000)
    settings = [f"search.transitions={few}", f"search.generator={generator}"]
    expected, report, lines = generated(settings=settings)
    journal = tmp_path / "journal"
    draw = random.Random(1)
    for _ in range(20):
        with pytest.raises(KilledError):
            generated(journal, draw.randrange(lines), settings)
    found, again, _ = generated(journal, settings=[*settings, "train.interactions=9"])
    for a, b in zip(found, expected, strict=True):
        np.testing.assert_array_equal(a, b)
    assert without_times(again) == without_times(report)
    assert again["units_from_journal"] > 0 and report["units_from_journal"] == 0


def test_times_are_those_of_all_answers(tmp_path):
    _, first, _ = generated(tmp_path / "journal")
    _, again, _ = generated(tmp_path / "journal")
    for key in ("reverse_cpu_s", "replay_cpu_s"):
        assert again[key] == pytest.approx(first[key])
    assert again["generate_cpu_s"] > again["reverse_cpu_s"] + again["replay_cpu_s"]


@pytest.mark.parametrize("setting", ["run.seed=2", "physics.sub_steps=9", "search.breadth=15"])
def test_the_journal_of_another_generation_is_not_used(tmp_path, setting):
    journal = tmp_path / "journal"
    generated(journal)
    _, report, _ = generated(journal, settings=[*LONG, setting])
    assert report["units_from_journal"] == 0


def test_a_damaged_journal_is_told_and_costs_no_row(tmp_path):
    journal = tmp_path / run_folder.JOURNAL_FILE
    expected, _, _ = generated(journal, settings=[])
    content = bytearray(journal.read_bytes())
    content[len(content) // 2] ^= 1
    journal.write_bytes(content)
    found, report, _ = generated(journal, settings=[])
    np.testing.assert_array_equal(found[0], expected[0])
    assert report["units_from_journal"] > 0
    assert 0 < report["journal_bytes_dropped"] <= len(content)


def plan_of(folder, *words):
    return make_plan(parse([*words, "--in-process", "--no-train", "--out", str(folder)]))


def test_a_resumed_run_goes_on_from_its_journal_and_removes_it(tmp_path):
    journal = tmp_path / run_folder.JOURNAL_FILE
    (tmp_path / "config.yaml").write_text(_core.Config.from_file(TINY).yaml)
    generated(journal, settings=[])
    plan = plan_of(tmp_path, "--resume", "--interactions", "900", "--workers", "1")
    with display(io.StringIO(), 100.0) as shown:
        run._generate_and_train(plan, shown)
    assert run_folder.read_json(plan.report_file)["units_from_journal"] > 0
    assert not journal.exists()


def test_a_journal_left_behind_complete_transitions_is_removed(tmp_path):
    plan = plan_of(tmp_path, str(TINY))
    with display(io.StringIO(), 100.0) as shown:
        run._generate_and_train(plan, shown)
        (tmp_path / run_folder.JOURNAL_FILE).touch()  # as a kill just before its removal leaves it
        run._generate_and_train(plan_of(tmp_path, "--resume"), shown)
    assert not (tmp_path / run_folder.JOURNAL_FILE).exists()


def test_a_journal_that_cannot_be_written_ends_the_run_with_its_name(tmp_path):
    config = _core.Config.from_file(TINY)
    generation = in_process.Generation(config, Recorder(config), tmp_path)
    with pytest.raises(RunError, match=f"^{tmp_path}: cannot be opened: Is a directory$"):
        while not generation.wait(0.1):
            pass
