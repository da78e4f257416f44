"""What is said where a package of an extra is missing."""

import sys

import pytest
from rtg import extras, paths
from rtg.errors import UserError

MISSING = "view needs the Python package {}, which is not installed; legal: after "


def test_in_a_checkout_the_packages_of_the_extra_are_named():
    with pytest.raises(UserError) as told:
        extras.require("no_such_package", "view", "view")
    install = f"{sys.executable} -m pip install 'rerun-sdk==0.41.0'"
    assert str(told.value) == MISSING.format("no_such_package") + install


def test_elsewhere_the_distribution_is_named_with_its_extra(monkeypatch):
    monkeypatch.setattr(paths, "IN_CHECKOUT", False)
    with pytest.raises(UserError) as told:
        extras.imported("no_such_package.part", "view", "view")
    install = f"{sys.executable} -m pip install 'reverse-trajectory-generation[view]'"
    assert str(told.value) == MISSING.format("no_such_package") + install


def test_what_is_there_is_imported():
    extras.require("json", "view", "view")
    assert extras.imported("json", "view", "view").loads("1") == 1
