"""The page of the departures from the paper."""

import re

import departures
import pytest

# What an audit of the code against the paper's text found: file and words of the mark of each.
AUDIT = {
    "friction counts the barrier's weight once": ("core/energy/slip_terms.hpp", "weight μ twice"),
    "friction has no time step": ("core/energy/slip_terms.hpp", "divides the slip by Δt"),
    "friction is smoothed": ("core/energy/slip_terms.hpp", "|u| is smoothed"),
    "range of the barrier": ("core/energy/barrier.hpp", "infinite range"),
    "forces at the start": ("core/energy/barrier.hpp", "bound the reverse SQP"),
    "quadratic turns, damping": ("core/energy/damping.hpp", "Quadratic is the default"),
    "quadratic turns, inertia": ("core/energy/inertia.hpp", "Quadratic is the default"),
    "separating axes": ("core/energy/separating_edges.hpp", "vertices alone"),
    "reduced coordinates": ("core/energy/articulation.hpp", "joints never open"),
    "gaps of the final state": ("core/energy/open_gaps.hpp", "takes the final state as it is"),
    "rest after a push": ("core/world/physics_config.hpp", "ends at rest"),
    "action consistency": ("core/reverse/problem/objective_terms.hpp", "how the robot moves"),
    "spring to the final state": (
        "core/reverse/problem/objective_terms.hpp",
        "fixes the final state",
    ),
    "fixed end with inertia": ("core/reverse/problem/objective_terms.hpp", "fixes p_{h-1} as well"),
    "speed penalty": ("core/reverse/problem/speed_penalty.hpp", "no such term"),
    "relaxed complementarity": ("core/reverse/problem/newton_system.hpp", "λ g = μ̃ w"),
    "warm start": ("core/reverse/problem/warm_start.hpp", "everything at rest"),
    "filter": ("core/reverse/sqp/filter_sqp.hpp", "filter instead of the merit function"),
    "Hessian of the Lagrangian": ("core/reverse/sqp/filter_sqp.hpp", "Hessian of the Lagrangian"),
    "restoration": ("core/reverse/sqp/sqp_strategy.hpp", "restoration of feasibility"),
    "safeguard": ("core/reverse/sqp/merit_sqp.cpp", "‖C‖₁ ≤ ε_c"),
    "decrease of the merit function": ("core/reverse/sqp/merit_sqp.cpp", "Eq. (11) asks for"),
    "refused steps": ("core/reverse/sqp/merit_sqp.cpp", "narrows a gap"),
    "pruning of headings": ("core/reverse/pruning.hpp", "all headings"),
    "pruning of bodies": ("core/reverse/pruning.hpp", "all bodies"),
    "several starts per solve": ("core/reverse/reverse_simulator.cpp", "one start"),
    "pairing of the KKT blocks": ("core/math/assembled_solver.hpp", "pentadiagonal"),
    "block elimination": ("core/math/riccati.hpp", "cyclic reduction"),
    "branches": ("core/search/branches.hpp", "steps of trees alone"),
    "plans that succeed": ("core/search/beam_search.hpp", "every replayed candidate"),
    "whole plans": ("core/search/beam_search.hpp", "plans are stored whole"),
    "drawn starts": ("core/search/start_distance.hpp", "as the reverse steps find them"),
    "the learner": ("nodes/config/train_config.hpp", "is the preset `paper`"),
}

# Of the audit's, those whose mark says its reason without a figure, and why.
WITHOUT_FIGURE = {
    "quadratic turns, inertia": "b³ per sub-step follows from the formula",
    "separating axes": "crossed bars are the counterexample",
    "reduced coordinates": "the paper leaves it open",
    "gaps of the final state": "the barrier does not exist without",
    "rest after a push": "the learner sees poses alone",
    "warm start": "what the static start costs has not been measured with this code",
    "pruning of bodies": "no result changes by a bit",
    "pairing of the KKT blocks": "the pattern of the printed matrix",
}
# A number, but not of an equation or a section of the paper, in a name such as Box2D, or a bare 0.
FIGURE = re.compile(r"(?<![\w.(])(?!0\b(?!\.\d))\d")


def test_the_page_says_what_the_code_says() -> None:
    assert departures.PAGE.read_text() == departures.page(), "run python tests/house/departures.py"


@pytest.mark.parametrize("what", AUDIT)
def test_every_departure_of_the_audit_is_marked(what: str) -> None:
    file, words = AUDIT[what]
    marks = [one.text for one in departures.departures() if one.file == file]
    assert any(words in mark for mark in marks)


def test_every_mark_is_of_the_audit() -> None:
    for one in departures.departures():
        assert any(one.file == file and words in one.text for file, words in AUDIT.values())


def test_marks_have_a_figure_or_say_why_they_need_none() -> None:
    exempt = [AUDIT[what] for what in WITHOUT_FIGURE]
    without = [one for one in departures.departures() if not FIGURE.search(one.text)]
    for one in without:
        assert any(one.file == file and words in one.text for file, words in exempt), one
    assert len(without) == len(exempt)  # none is exempt that has one
