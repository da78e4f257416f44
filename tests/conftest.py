"""The order of the tests."""

import pytest


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Puts the files of tests/system, the longest ones, first: processes side by side end alike."""
    items.sort(key=lambda item: item.path.parent.name != "system")
