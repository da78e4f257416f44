"""The generated Python types agree with what the C++ test pins."""

import re

import pytest
from rtg import paths
from rtg.bus import messages

PINNED = dict(
    re.findall(
        r'fingerprint<(\w+)>\(\), "(\w{16})"',
        (paths.ROOT / "tests/msgs/fingerprint_test.cpp").read_text(),
    )
)


def test_every_type_is_there():
    assert sorted(PINNED) == messages.NAMES


@pytest.mark.parametrize("name", messages.NAMES)
def test_a_type_has_the_fingerprint_of_its_c_plus_plus_twin(name):
    data = messages.message_type(name)().encode()
    assert data[:8].hex() == PINNED[name]
    assert messages.type_of(data) is messages.message_type(name)


def test_bytes_of_no_type_of_ours_have_no_type():
    assert messages.type_of(b"") is None
    assert messages.type_of(bytes(64)) is None
