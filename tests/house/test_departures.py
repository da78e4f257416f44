"""The page of the departures from the paper."""

import departures
import pytest

# What an audit of the code against the paper's text found: file and words of the mark of each.
AUDIT = {
    "friction counts the barrier's weight once": ("energy/slip_terms.hpp", "stands in P_∥ twice"),
    "friction has a time step": ("energy/slip_terms.hpp", "does not vanish with Δt"),
    "friction is smoothed": ("energy/slip_terms.hpp", "|u| is smoothed"),
    "friction's derivatives are whole": ("energy/slip_terms.hpp", "derivatives of λ"),
    "range of the barrier": ("energy/barrier.hpp", "infinite range"),
    "forces at the start": ("energy/barrier.hpp", "bound the reverse SQP"),
    "quadratic turns, damping": ("energy/damping.hpp", "Quadratic is the default"),
    "quadratic turns, inertia": ("energy/inertia.hpp", "Quadratic is the default"),
    "separating axes": ("energy/separating_edges.hpp", "vertices alone"),
    "reduced coordinates": ("energy/articulation.hpp", "joints never open"),
    "gaps of the final state": ("energy/open_gaps.hpp", "takes the final state as it is"),
    "rest after a push": ("world/physics_config.hpp", "ends at rest"),
    "action consistency": ("reverse/problem/objective_terms.hpp", "how the robot moves"),
    "spring to the final state": ("reverse/problem/objective_terms.hpp", "fixes the final state"),
    "speed penalty": ("reverse/problem/speed_penalty.hpp", "no such term"),
    "relaxed complementarity": ("reverse/problem/newton_system.hpp", "λ g = μ̃ w"),
    "warm start": ("reverse/problem/warm_start.hpp", "everything at rest"),
    "filter": ("reverse/sqp/filter_sqp.hpp", "filter instead of the merit function"),
    "Hessian of the Lagrangian": ("reverse/sqp/filter_sqp.hpp", "Hessian of the Lagrangian"),
    "restoration": ("reverse/sqp/sqp_strategy.hpp", "restoration of feasibility"),
    "safeguard": ("reverse/sqp/merit_sqp.cpp", "‖C‖₁ ≤ ε_c"),
    "decrease of the merit function": ("reverse/sqp/merit_sqp.cpp", "Eq. (11) asks for"),
    "refused steps": ("reverse/sqp/merit_sqp.cpp", "narrows a gap"),
    "pruning of headings": ("reverse/pruning.hpp", "all headings"),
    "pruning of bodies": ("reverse/pruning.hpp", "all bodies"),
    "several starts per solve": ("reverse/reverse_simulator.cpp", "one start"),
    "pairing of the KKT blocks": ("math/assembled_solver.hpp", "pentadiagonal"),
    "block elimination": ("math/riccati.hpp", "cyclic reduction"),
    "branches": ("search/branches.hpp", "steps of trees alone"),
}


def test_the_page_says_what_the_code_says() -> None:
    assert departures.PAGE.read_text() == departures.page(), "run python tests/house/departures.py"


@pytest.mark.parametrize("what", AUDIT)
def test_every_departure_of_the_audit_is_marked(what: str) -> None:
    file, words = AUDIT[what]
    marks = [one.text for one in departures.departures() if one.file == f"core/{file}"]
    assert any(words in mark for mark in marks)


def test_every_mark_is_of_the_audit() -> None:
    for one in departures.departures():
        assert any(
            one.file == f"core/{file}" and words in one.text for file, words in AUDIT.values()
        )


def test_marks_have_a_reason() -> None:
    assert [one for one in departures.departures() if len(one.text) < 20] == []
