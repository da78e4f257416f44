"""Checks which runs generate first and then learn side by side."""

import pytest
from rtg.compare import grouped_seeds
from rtg.compare.cell_run import prepare_runs
from rtg.compare.reproduce_args import parse
from rtg.files.run_folder import write_json
from rtg.learn import device
from training_runs import TINY


@pytest.fixture
def runs(tmp_path):
    """Prepares the runs of two methods, one of them with offline data, two seeds each."""
    words = [str(TINY), "--methods", "ddqn,ddqn_naive", "--seeds", "2", "--out", str(tmp_path)]
    return prepare_runs(parse(words))


def names(jobs):
    return [job.name.split("/", 1)[1] for job in jobs]


def test_all_generate_and_then_the_seeds_of_each_method_learn(runs):
    generations, learnings = grouped_seeds.stages(runs, together=True)
    assert names(generations) == [f"ddqn_naive/seed-{k}: transitions" for k in (1, 2)]
    assert names(learnings) == ["ddqn: 2 seeds learn", "ddqn_naive: 2 seeds learn"]
    assert not any(job.done for job in (*generations, *learnings))


def test_a_seed_alone_and_what_is_done_is_left_to_its_run(runs):
    done = runs[0].folder / "summary.json"
    done.parent.mkdir(parents=True)
    write_json(done, {"interactions": 1, "success_rate": 0.5})
    generations, learnings = grouped_seeds.stages(runs, together=True)
    assert len(generations) == 2 and names(learnings) == ["ddqn_naive: 2 seeds learn"]


@pytest.mark.parametrize(("where", "count"), [("cpu", 0), ("cuda", 2)])
def test_on_a_gpu_they_do_so_unasked(runs, monkeypatch, where, count):
    asked = []
    monkeypatch.setattr(device, "chosen", lambda wanted: asked.append(wanted) or where)
    assert len(grouped_seeds.stages(runs, together=False)[1]) == count
    assert set(asked) == {"auto"}
