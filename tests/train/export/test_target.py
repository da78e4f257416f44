"""The folder that an export writes, and who else may."""

import pytest
from rtg.errors import UserError
from rtg.export import target


def test_a_folder_is_that_of_one_export_at_a_time(tmp_path):
    with target.held(tmp_path / "new" / "out"):
        with pytest.raises(UserError) as told, target.held(tmp_path / "new" / "out"):
            pytest.fail("is held")
        words = "another export writes it; legal: another folder, or wait"
        assert str(told.value) == f"--out: {tmp_path / 'new' / 'out'}: {words}"
        with target.held(tmp_path / "new" / "other"):
            pass
    with target.held(tmp_path / "new" / "out"):
        assert not (tmp_path / "new" / "out").exists()


def test_what_cannot_be_written_is_bad_input(tmp_path):
    (tmp_path / "file").touch()
    legal = "legal: a folder to write to"
    with (
        pytest.raises(UserError, match=f"file/out: File exists; {legal}"),
        target.held(tmp_path / "file" / "out"),
    ):
        pytest.fail("is no folder")
    with (
        pytest.raises(UserError, match=f"out: disc is full; {legal}"),
        target.held(tmp_path / "out"),
    ):
        raise OSError("disc is full")
    with target.held(tmp_path / "out"):  # an error frees it
        pass


def test_an_error_of_another_file_is_not_told_of_the_target(tmp_path):
    missing = tmp_path / "font.ttf"
    with (
        pytest.raises(UserError, match=f"^{missing}: No such file or directory; legal: "),
        target.held(tmp_path / "out"),
    ):
        missing.read_bytes()


def test_a_draft_is_new_and_gone_afterwards(tmp_path):
    (tmp_path / ".out.part").mkdir()
    (tmp_path / ".out.part" / "old").touch()
    with target.draft(tmp_path / "out") as draft:
        assert draft == tmp_path / ".out.part" and not draft.exists()
        draft.mkdir()
    with pytest.raises(KeyError), target.draft(tmp_path / "out") as draft:
        draft.mkdir()
        raise KeyError
    assert list(tmp_path.iterdir()) == []
