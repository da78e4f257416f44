"""What a run with a forward simulator of Python says before it begins."""

import re
from pathlib import Path

import pytest
import rtg
from rtg.run import engine_time
from rtg.run.plan import make_plan
from rtg.run.run_args import parse

TOYS = Path(__file__).parents[1] / "engines"


def test_simulators_of_the_core_are_not_waited_for() -> None:
    assert engine_time.words(rtg.load_task("gathering").config, 49000, 350000) == []


def test_the_pushes_of_others_are_counted_and_timed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(TOYS))
    engine = ["--set", "forward.engine=toy_engines:Ghost"]
    words = ["gathering", "--in-process", *engine, "--out", str(tmp_path / "run")]
    # 4 pushes for each of 49,000 transitions; 350,000 interactions, 140 evaluations of 100 episodes
    time = r"\d+:\d\d(:\d\d)?"
    (said,) = make_plan(parse(words)).notes
    assert re.fullmatch(
        r"forward.engine toy_engines:Ghost: \S+ ms a push that meets a body; about 196,000 pushes "
        rf"for the transitions, {time}, and at most 1,190,000 for learning, {time}",
        said,
    )
    assert make_plan(parse(["--resume", "--out", str(tmp_path / "run")])).notes == ()
