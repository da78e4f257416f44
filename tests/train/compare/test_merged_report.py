"""Reports of shards together say what one report on all of it would."""

import json
from typing import Any

import pytest
from rtg import _core
from rtg.compare.merged_report import merged
from training_runs import TINY

TIMES = {"generate_wall_s", "generate_cpu_s", "reverse_cpu_s", "replay_cpu_s", "generation_stages"}


def report(*settings: str) -> dict[str, Any]:
    config = _core.Config.from_file(TINY, ["search.breadth=8", *settings])
    return json.loads(_core.generate(config, lambda *_: None, lambda _: None))


@pytest.mark.parametrize("generator", ["naive", "rrbs", "random"])
def test_it_is_that_of_one_process(generator: str) -> None:
    settings = [f"search.generator={generator}", "search.branches=2"]
    parts = [
        report(*settings, f"search.transitions={count}", f"search.shard={k}")
        for k, count in enumerate((150, 150, 151))
    ]
    whole = report(*settings, "search.transitions=451", "search.shards=3")
    found = merged(parts)
    assert found.keys() == whole.keys()
    lists = {key for key, value in whole.items() if isinstance(value, list)}
    for key in whole.keys() - TIMES:
        expected = whole[key] if key in lists else pytest.approx(whole[key])
        assert found[key] == expected, key


def test_times_are_added_but_for_the_wall_clock_of_what_went_on_side_by_side() -> None:
    one = report("search.transitions=50", "search.shard=0")
    other = {**report("search.transitions=60", "search.shard=1"), "generate_wall_s": 1e3}
    found = merged([one, other])
    assert found["generate_wall_s"] == 1e3
    assert found["generate_cpu_s"] == one["generate_cpu_s"] + other["generate_cpu_s"]
    stage = [part["generation_stages"]["solves"]["cpu_s"] for part in (one, other)]
    assert found["generation_stages"]["solves"]["cpu_s"] == sum(stage)


def test_what_a_shard_fell_short_of_is_told() -> None:
    short = {**report("search.transitions=50"), "shortfalls": ["too few"]}
    assert merged([short, report("search.transitions=50", "search.shard=1")])["shortfalls"] == [
        "too few"
    ]


def test_shards_without_transitions_have_no_part_in_means() -> None:
    one = report("search.transitions=50", "search.shard=0")
    none = {**one, "transitions": 0, "headings_per_state": 0.0, "contact_share": 0.0}
    found = merged([one, none])
    for key in ("transitions", "headings_per_state", "contact_share"):
        assert found[key] == pytest.approx(one[key]), key
    assert merged([none, none])["headings_per_state"] == 0.0
