"""The learner's state as the display sees it."""

import json

from rtg.run.run_state import RunState
from rtg.run.training_watch import TrainingWatch


def test_the_learner_is_shown_as_it_writes(tmp_path):
    watch = TrainingWatch(tmp_path)
    state = RunState(phase="round 1", budget=400)
    assert watch.update(state) == state
    file = tmp_path / "training_state.json"
    file.write_text(json.dumps({"interactions": 100, "evaluations": 0, "success_rate": None}))
    shown = watch.update(state)
    assert (shown.phase, shown.interactions, shown.success_rate) == ("round 1", 100, None)
    file.write_text(json.dumps({"interactions": 200, "evaluations": 3, "success_rate": 0.5}))
    shown = watch.update(state)
    assert (shown.interactions, shown.evaluations, shown.success_rate) == (200, 3, 0.5)
    assert shown.rate > 0.0
