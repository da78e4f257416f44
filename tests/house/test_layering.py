import pytest
from layering import ROOT, sources, violations


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
        ("core/search/a.cpp", '#include "nodes/common/bus.hpp"'),
        ("core/search/a.cpp", "#include <lcm/lcm-cpp.hpp>"),
        ("core/tasks/a.cpp", "#include <yaml-cpp/yaml.h>"),
        ("core/math/a.hpp", "  #  include <umfpack.h>"),
        ("core/forward/simulator.hpp", "#include <box2d/box2d.h>"),
        ("nodes/reverse_worker/main.cpp", "#include <lcm/lcm-cpp.hpp>"),
        ("nodes/common/config.hpp", "#include <yaml-cpp/yaml.h>"),
        ("train/bindings/module.cpp", '#include "nodes/reverse_worker/node.hpp"'),
        ("core/math/a.cpp", "#include <boost/any.hpp>"),
        ("core/math/a.cpp", "#include <gtest/gtest.h>"),
        ("train/rtg/trainer.py", "import lcm"),
        ("tests/train/test_a.py", "    from lcm import LCM"),
    ],
)
def test_a_wrong_include_is_found(path: str, line: str) -> None:
    assert len(violations({path: f"#pragma once\n{line}\n"})) == 1


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("core/search/a.cpp", '#include "core/tasks/task.hpp"'),
        ("core/math/oracle.cpp", "#include <suitesparse/umfpack.h>"),
        ("core/forward/box2d_simulator.cpp", "#include <box2d/box2d.h>"),
        ("nodes/common/bus.cpp", "#include <lcm/lcm-cpp.hpp>"),
        ("nodes/common/convert.cpp", '#include "rtg_msgs/transition_t.hpp"'),
        ("core/math/a.hpp", "#include <experimental/simd>"),
        ("train/rtg/bus.py", "import lcm"),
    ],
)
def test_a_right_include_passes(path: str, line: str) -> None:
    assert violations({path: f"{line}\n"}) == []
