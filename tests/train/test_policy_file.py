"""Files from outside that shall be policies."""

from pathlib import Path

import pytest
from rtg import _core, checkpoint, paths, policy_file
from rtg.errors import UserError

TASK = _core.Config.from_file(paths.CONFIG / "tests" / "tiny.yaml").task
FITTING = {"observation_size": 20, "headings": 48, "dueling": True, "layer_norm": True}


@pytest.mark.parametrize(
    ("state", "message"),
    [
        ({}, "it does not say what made it"),
        ({"identity": {}}, "made with observation_size = None; this run has 20"),
        ({"identity": FITTING, "model": {}}, "holds no policy"),
        ({"identity": FITTING, "weights": {}}, "the weights do not fit"),
    ],
)
def test_files_of_another_kind_are_no_policies(
    tmp_path: Path, state: dict[str, object], message: str
) -> None:
    file = tmp_path / "model.pt"
    checkpoint.write(file, state)
    with pytest.raises(UserError, match=message):
        policy_file.read(file, TASK)
