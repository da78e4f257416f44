"""The Python of the README runs as it stands there."""

import re
from pathlib import Path

import pytest
import rtg
from rtg import paths


def test_the_blocks_of_python_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a tiny task in the place of push_t, so that they take seconds."""
    load = rtg.load_task
    tiny = paths.CONFIG / "tests" / "tiny.yaml"
    asked = []

    def load_tiny(task: str) -> rtg.Task:
        asked.append(task)
        return load(tiny, ["train.eval_episodes=3", "search.transitions=600"])

    monkeypatch.setattr(rtg, "load_task", load_tiny)
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (paths.ROOT / "README.md").read_text(), re.DOTALL)
    assert len(blocks) == 2
    names: dict[str, object] = {}
    for block in blocks:
        exec(block, names)
    assert asked == ["push_t"]
    assert isinstance(names["policy"], rtg.Policy) and 0 <= int(names["action"]) < 48
