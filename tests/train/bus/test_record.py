"""The recorder of transitions: what it is asked to write to."""

import pytest
from rtg import paths
from rtg.bus import record


@pytest.mark.parametrize(
    ("name", "wrong"), [("absent/a.npz", "absent: no such folder"), (".", ": is a folder")]
)
def test_a_file_that_cannot_be_written_is_refused_before_the_wait(tmp_path, capsys, name, wrong):
    config = paths.CONFIG / "gathering.yaml"
    assert record.main([str(config), "run", str(tmp_path / name)]) == 2
    assert f"{wrong}; legal: a file in a folder that exists" in capsys.readouterr().err
