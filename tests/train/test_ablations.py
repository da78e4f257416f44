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
    *departures, as_paper = ablations(FILE, [])
    taken_back = [Override("", word) for words in departures for word in words]
    found = effective_config.values(FILE, taken_back)["train"]
    paper = effective_config.values(FILE, [Override("", word) for word in as_paper])["train"]
    assert {key for key in paper if found[key] != paper[key]} == {"preset"}
    ours = effective_config.values(FILE)["train"]
    watched = ("interactions", "eval_every", "stop_at_success", "stop_evaluations")
    assert [paper[key] for key in watched] == [ours[key] for key in watched]


def test_data_found_forwards_are_left_out_one_by_one_and_together():
    mended, roll_outs = "search.mended=0", "search.rollout_share=0"
    assert ablations(FILE, [])[:4] == [(), (mended,), (roll_outs,), (mended, roll_outs)]
    assert ablations(FILE, [Override("", mended)])[1] == (roll_outs,)
    for method in ("her", "ddqn_random"):  # without data, without trees
        for words in ablations(FILE, [Override("", f"run.method={method}")]):
            assert not {mended, roll_outs} & set(words)


def test_of_the_paper_nothing_is_taken_back():
    found = ablations(FILE, [Override("", PAPER)])
    assert all(word.startswith("search.") for settings in found for word in settings)


def test_what_is_set_for_all_is_no_departure():
    common = [Override("", "train.batch=512"), Override("", "run.method=ddqn")]
    common.append(Override("", "train.stop_at_success=0.5"))
    found = ablations(FILE, common)
    words = [word.partition("=")[0] for settings in found for word in settings]
    assert not {"train.batch", "train.nearby_share"} & set(words)
    assert found[-1] == (PAPER, "train.eval_every=5000", "train.stop_at_success=0.5")
