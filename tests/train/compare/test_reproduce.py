"""The command `reproduce`, as far as it comes before the first run; tests/system has the rest."""

import pytest
from rtg import cli
from training_runs import TINY


@pytest.mark.parametrize("folder", ["/proc/rtg", "/proc"])
def test_a_folder_that_cannot_be_written_is_named(folder, capsys):
    assert cli.main(["reproduce", str(TINY), "--out", folder]) == 2
    assert capsys.readouterr().err.startswith(f"rtg: --out: {folder}: ")
