"""The page of the departures from the paper."""

import departures
import pytest

# What an audit of the code against the paper's text found: each has a mark in the file named.
AUDIT = {
    "friction counts the barrier's weight once, and has a time step": "core/energy/slip_terms.hpp",
    "friction is smoothed": "core/energy/slip_terms.hpp",
    "range of the barrier": "core/energy/barrier.hpp",
    "quadratic turns, damping": "core/energy/damping.hpp",
    "quadratic turns, inertia": "core/energy/inertia.hpp",
    "separating axes": "core/energy/separating_edges.hpp",
    "reduced coordinates": "core/energy/articulation.hpp",
    "action consistency, spring to the final state": "core/reverse/problem/objective_terms.hpp",
    "speed penalty": "core/reverse/problem/speed_penalty.hpp",
    "relaxed complementarity": "core/reverse/problem/newton_system.hpp",
    "warm start": "core/reverse/problem/warm_start.hpp",
    "filter, Hessian of the Lagrangian": "core/reverse/sqp/filter_sqp.hpp",
    "safeguard": "core/reverse/sqp/merit_sqp.cpp",
    "pruning": "core/reverse/pruning.hpp",
    "several starts per solve": "core/reverse/reverse_simulator.cpp",
    "pairing of the KKT blocks": "core/math/assembled_solver.hpp",
    "block elimination": "core/math/riccati.hpp",
    "branches": "core/search/branches.hpp",
}


def test_the_page_says_what_the_code_says() -> None:
    assert departures.PAGE.read_text() == departures.page(), "run python tests/house/departures.py"


@pytest.mark.parametrize("what", AUDIT)
def test_every_departure_of_the_audit_is_marked(what: str) -> None:
    assert AUDIT[what] in {one.file for one in departures.departures()}


def test_marks_have_a_reason() -> None:
    assert [one for one in departures.departures() if len(one.text) < 20] == []
