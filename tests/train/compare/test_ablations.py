"""Checks what is taken back of the preset `default`, one after the other."""

from rtg import paths
from rtg.compare.ablations import (
    BRANCH_ABLATIONS,
    PAPER_PRESET,
    TREE_ABLATIONS,
    ablations,
    departures,
    search_ablations,
)
from rtg.run import effective_config
from rtg.run.run_args import Override

FILE = paths.CONFIG / "sorting.yaml"


def test_what_differs_is_taken_back_key_by_key():
    current = {"batch": 256, "network": "headings", "discount": 0.95, "eval_every": 5000}
    paper = {"batch": 512, "network": "plain", "discount": 0.95, "eval_every": 10000}
    assert departures(current, paper) == [("train.batch=512",), ("train.network=plain",)]


def test_keys_that_belong_together_are_taken_back_together():
    current = {"target_sync": 1, "target_rate": 0.005}
    paper = {"target_sync": 250, "target_rate": 1.0}
    assert departures(current, paper) == [("train.target_sync=250", "train.target_rate=1.0")]


def test_all_departures_together_are_the_paper_but_for_how_it_is_measured():
    *departures, as_paper = ablations(FILE, [])
    words = [word for words in departures for word in words if word.startswith("train.")]
    taken_back = [Override("", word) for word in words]
    found = effective_config.values(effective_config.load(FILE, taken_back))["train"]
    paper = effective_config.values(
        effective_config.load(FILE, [Override("", word) for word in as_paper])
    )["train"]
    assert {key for key in paper if found[key] != paper[key]} == {"preset"}
    current = effective_config.values(effective_config.load(FILE))["train"]
    watched = ("interactions", "eval_every", "stop_at_success", "stop_evaluations")
    assert [paper[key] for key in watched] == [current[key] for key in watched]


def test_every_setting_of_the_search_has_an_ablation_or_is_a_size_or_of_the_method():
    search = effective_config.values(effective_config.load(FILE))["search"]
    sizes = {"transitions", "breadth", "forward_breadth", "depth", "shard", "shards"}
    set_by_method = {"generator", "randomise"}
    ablated = {*BRANCH_ABLATIONS, *TREE_ABLATIONS}
    assert ablated == set(search) - sizes - set_by_method


def test_the_loader_takes_every_part_of_the_search_away():
    before = effective_config.values(effective_config.load(FILE))["search"]
    for (word,) in search_ablations(before):
        after = effective_config.values(effective_config.load(FILE, [Override("", word)]))["search"]
        key = word.partition("=")[0].removeprefix("search.")
        assert {name for name in before if before[name] != after[name]} == {key}, word


def test_what_the_search_is_without_is_not_taken_away():
    search = effective_config.values(
        effective_config.load(FILE, [Override("", "search.whole_plan_share=0")])
    )["search"]
    alternatives = {words[0] for words in search_ablations(search)}
    assert (
        "search.whole_plan_share=1" in alternatives
        and "search.whole_plan_share=0" not in alternatives
    )


def test_only_trees_lose_parts_of_trees_and_only_data_any():
    for method, lost in (("ddqn_naive", True), ("ddqn_scatter", False), ("her", False)):
        found = ablations(FILE, [Override("", f"run.method={method}")])
        assert (("search.whole_plan_share=0",) in found) == lost
        assert (("search.branches=0",) in found) == (method != "her")


def test_of_the_paper_nothing_is_taken_back():
    found = ablations(FILE, [Override("", PAPER_PRESET)])
    assert all(word.startswith("search.") for settings in found for word in settings)


def test_what_is_set_for_all_is_no_departure():
    common = [Override("", "train.batch=512"), Override("", "run.method=ddqn")]
    common.append(Override("", "train.stop_at_success=0.5"))
    found = ablations(FILE, common)
    words = [word.partition("=")[0] for settings in found for word in settings]
    assert not {"train.batch", "train.nearby_share"} & set(words)
    assert found[-1] == (PAPER_PRESET, "train.eval_every=2500", "train.stop_at_success=0.5")
