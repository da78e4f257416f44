"""Where there is no network to test in, nobody is told that the system tests passed."""

import network
import pytest


@pytest.mark.parametrize(
    ("environment", "outcome"),
    [
        ("true", pytest.fail.Exception),
        ("false", pytest.skip.Exception),
        (None, pytest.skip.Exception),
    ],
)
def test_a_missing_network_skips_here_and_fails_on_ci(monkeypatch, environment, outcome):
    monkeypatch.setattr(network, "defect", lambda: "unshare failed: Operation not permitted")
    monkeypatch.delenv("CI", raising=False)
    if environment is not None:
        monkeypatch.setenv("CI", environment)
    with pytest.raises(outcome, match="no network namespaces here: unshare failed: Operation not"):
        network.require()


def test_with_a_network_nothing_is_skipped_on_ci(monkeypatch):
    monkeypatch.setattr(network, "defect", lambda: None)
    monkeypatch.setenv("CI", "true")
    network.require()
