"""`rtg export` on the command line."""

import sys

import pytest
from exported import run_folder
from rtg.cli import main
from rtg.files import run_folder as files
from time_limit import run


def refused(capsys, *words):
    assert main(["export", *words]) == 2
    return capsys.readouterr().err


def test_bad_words_are_refused(capsys, tmp_path):
    assert "invalid choice: 'csv'" in refused(capsys, "csv", "run")
    assert "nowhere: no such folder; legal: the folder of a run" in refused(
        capsys, "minari", "nowhere"
    )
    assert "--episodes 0: legal: a number from 1" in refused(
        capsys, "minari", "run", "--episodes", "0"
    )
    assert "--out: the path is empty" in refused(capsys, "minari", "run", "--out", "")


def test_a_changed_file_is_refused(capsys, tmp_path):
    run = run_folder(tmp_path / "run")
    made = files.read_json(run / "versions.json")
    made["generator"]["sha256"]["transitions.npz"] = "0" * 64
    files.write_json(run / "versions.json", made)
    assert "was changed since the run wrote it" in refused(capsys, "minari", str(run))


@pytest.mark.parametrize(("format", "package"), [("minari", "minari"), ("lerobot", "av")])
def test_a_folder_that_cannot_be_written_is_refused(format, package, capsys, tmp_path):
    pytest.importorskip(package, reason=f"the extra `{format}` is not installed")
    run = run_folder(tmp_path / "run")
    (tmp_path / "file").touch()
    for out in (tmp_path / "file", tmp_path / "file" / "out"):
        said = refused(capsys, format, str(run), "--out", str(out), "--episodes", "1")
        assert said.startswith(f"rtg: --out: {out}")
        assert "legal: a" in said and said.count("\n") == 1
    assert (tmp_path / "file").read_bytes() == b""


def test_no_optional_package_is_imported_by_others():
    """Whoever does not export needs none of them."""
    code = "import sys, rtg.cli, rtg.run.run, rtg.export.command; print(*sys.modules)"
    done = run(sys.executable, "-c", code, check=True)
    assert not {"minari", "h5py", "pyarrow", "pandas", "av"} & set(done.stdout.split())


def test_a_data_set_of_minari_is_written(tmp_path, capsys):
    pytest.importorskip("minari", reason="the extra `minari` is not installed")
    run = run_folder(tmp_path / "run")
    words = ["export", "minari", str(run), "--out", str(tmp_path), "--episodes", "2"]
    assert main(words) == 0
    said = capsys.readouterr().out
    assert said.startswith("rtg/gathering/naive-plans-v0: 2 episodes,")
    assert (tmp_path / "rtg/gathering/naive-plans-v0/data/metadata.json").is_file()
