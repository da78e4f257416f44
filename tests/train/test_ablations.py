"""What is taken back of the preset `default`, one after the other."""

from rtg import effective_config, paths
from rtg.ablations import PAPER, ablations, departures
from rtg.run_args import Override

FILE = paths.CONFIG / "sorting.yaml"


def test_what_differs_is_taken_back_key_by_key():
    ours = {"batch": 256, "dueling": True, "discount": 0.95, "eval_every": 5000}
    paper = {"batch": 512, "dueling": False, "discount": 0.95, "eval_every": 10000}
    assert departures(ours, paper) == [("train.batch=512",), ("train.dueling=false",)]


def test_keys_that_belong_together_are_taken_back_together():
    ours = {"target_sync": 1, "target_rate": 0.005}
    paper = {"target_sync": 2500, "target_rate": 1.0}
    assert departures(ours, paper) == [("train.target_sync=2500", "train.target_rate=1.0")]


def test_all_departures_together_are_the_paper_but_for_how_it_is_measured():
    taken_back = [Override("", word) for words in ablations(FILE)[1:-1] for word in words]
    found = effective_config.values(FILE, taken_back)["train"]
    paper = effective_config.values(FILE, [Override("", PAPER)])["train"]
    differ = {key for key in paper if found[key] != paper[key]}
    assert differ == {"preset", "eval_every", "stop_at_success"}
