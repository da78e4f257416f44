import ast
from graphlib import TopologicalSorter

import pytest
from layering import ROOMS, ROOT, sources, violations


def test_every_include_follows_the_arrows() -> None:
    files = {
        str(path.relative_to(ROOT)): path.read_text()
        for path in sources(".hpp", ".cpp", ".h", ".py")
    }
    assert len(files) > 20
    assert violations(files) == []


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("core/math/a.hpp", '#include "core/world/pose.hpp"'),
        ("core/world/a.hpp", '#include "core/tasks/task.hpp"'),
        ("core/reverse/a.cpp", '#include "core/forward/simulator.hpp"'),
        ("core/search/a.cpp", '#include "nodes/bus/bus.hpp"'),
        ("core/search/a.cpp", "#include <lcm/lcm-cpp.hpp>"),
        ("core/tasks/a.cpp", "#include <yaml-cpp/yaml.h>"),
        ("core/math/a.hpp", "  #  include <umfpack.h>"),
        ("core/forward/simulator.hpp", "#include <box2d/box2d.h>"),
        ("nodes/reverse_worker/main.cpp", "#include <lcm/lcm-cpp.hpp>"),
        ("nodes/config/config.hpp", "#include <yaml-cpp/yaml.h>"),
        ("nodes/bus/a.hpp", '#include "nodes/jobs/services.hpp"'),
        ("nodes/reverse_worker/a.hpp", '#include "nodes/beam_coordinator/unit_table.hpp"'),
        ("core/reverse/problem/a.hpp", '#include "core/reverse/sqp/filter.hpp"'),
        ("train/bindings/module.cpp", '#include "nodes/reverse_worker/node.hpp"'),
        ("core/math/a.cpp", "#include <boost/any.hpp>"),
        ("core/math/a.cpp", "#include <gtest/gtest.h>"),
        ("train/rtg/learn/trainer.py", "import lcm"),
        ("tests/train/test_a.py", "    from lcm import LCM"),
    ],
)
def test_a_wrong_include_is_found(path: str, line: str) -> None:
    assert len(violations({path: f"{line}\n"})) == 1


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("train/rtg/files/a.py", "from rtg.bus.bus import Bus"),
        ("train/rtg/learn/a.py", "from rtg.run import plan"),
        ("train/rtg/learn/a.py", "def f():\n    import rtg.compare.report"),
        ("train/rtg/envs/a.py", "from rtg import cli"),
        ("train/rtg/cellar/a.py", "import numpy"),
        ("train/rtg/learn/a.py", "import rtg"),
        ("train/rtg/learn/a.py", "from ..run import plan"),
        ("train/rtg/learn/a.py", "from . import ddqn"),
        ("train/rtg/paths.py", "from rtg.run import plan"),
    ],
)
def test_a_wrong_import_is_found(path: str, line: str) -> None:
    assert len(violations({path: f"{line}\n"})) == 1


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("train/rtg/learn/a.py", "from rtg import _core, errors"),
        ("train/rtg/learn/a.py", "from rtg.learn.ddqn import DoubleDqn"),
        ("train/rtg/run/a.py", "from rtg.learn import device"),
        ("train/rtg/cli.py", "from rtg.compare import reproduce"),
    ],
)
def test_a_right_import_passes(path: str, line: str) -> None:
    assert violations({path: f"{line}\n"}) == []


def test_rooms_import_downwards_alone() -> None:
    order = list(ROOMS)
    for room, below in ROOMS.items():
        assert all(order.index(other) < order.index(room) for other in below)


def test_no_module_of_a_room_imports_in_a_circle() -> None:
    """Imports for type checkers do not count."""
    of = {}
    for path in sources(".py"):
        parts = path.relative_to(ROOT).with_suffix("").parts
        if parts[:2] == ("train", "rtg"):
            name = ".".join(parts[1:]).removesuffix(".__init__")
            text = path.read_text().replace("if TYPE_CHECKING:", "def f():")
            tree = [n for n in ast.parse(text).body if isinstance(n, ast.Import | ast.ImportFrom)]
            of[name] = {m for n in tree for m in modules(n)}
    whole = "rtg"  # which every module of it imports
    graph = {name: {m for m in found if m in of} - {whole} for name, found in of.items()}
    assert len(graph) > 60
    list(TopologicalSorter(graph).static_order())  # raises CycleError


def modules(node: ast.Import | ast.ImportFrom) -> list[str]:
    """Lists what the statement may import, dotted."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    return [str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names)]


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("core/search/a.cpp", '#include "core/tasks/task.hpp"'),
        ("core/math/oracle.cpp", "#include <suitesparse/umfpack.h>"),
        ("core/forward/box2d_simulator.cpp", "#include <box2d/box2d.h>"),
        ("nodes/bus/network.cpp", "#include <lcm/lcm-cpp.hpp>"),
        ("nodes/jobs/convert.cpp", '#include "rtg_msgs/transition_t.hpp"'),
        ("core/math/a.hpp", "#include <experimental/simd>"),
        ("train/rtg/bus/bus.py", "import lcm"),
    ],
)
def test_a_right_include_passes(path: str, line: str) -> None:
    assert violations({path: f"{line}\n"}) == []
