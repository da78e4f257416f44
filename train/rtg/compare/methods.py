"""The tasks and methods of comparisons."""

from __future__ import annotations

from rtg import _core

TASKS = ("gathering", "sorting", "art_manip")
METHODS = _core.METHODS
REFERENCE = "ddqn_rtg"  # the method with which the others are compared
SEEDLESS = "planner"  # all seeds have the same results
RANDOMISED = "ddqn_rtg_dr"  # starts in a wider region, so its success is not comparable
