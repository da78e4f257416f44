"""The recorder of transitions: what it is asked to write to."""

import pytest
from rtg import paths
from rtg.bus import record
from rtg.bus.bus import new_key


@pytest.mark.parametrize(
    ("name", "wrong"), [("absent/a.npz", "absent: no such folder"), (".", ": is a folder")]
)
def test_a_file_that_cannot_be_written_is_refused_before_the_wait(tmp_path, capsys, name, wrong):
    config, key = paths.CONFIG / "gathering.yaml", tmp_path / "run.key"
    new_key(key, "run")
    assert record.main([str(config), str(key), str(tmp_path / name)]) == 2
    assert f"{wrong}; legal: a file in a folder that exists" in capsys.readouterr().err
