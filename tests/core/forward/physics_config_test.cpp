#include "core/world/physics_config.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "core/forward/box2d_simulator.hpp"
#include "core/forward/newton_simulator.hpp"
#include "tests/support/each_field.hpp"

namespace rtg::forward {
namespace {

/// A robot that pushes a box off centre into a wall.
const Scene kScene{{{"robot", "robot", box(1.0, 1.0), 1.0, 0.5, false},
                    {"box", "box", box(1.2, 1.2), 1.0, 0.5, false},
                    {"wall", "wall", box(0.5, 6.0), 1.0, 0.5, true}}};
const Poses kStart{{0, 0.4, 0}, {1.3, 0, 0.1}, {3.0, 0, 0}};

/// Returns where a push ends in either simulator.
std::pair<Poses, Poses> ends(const PhysicsConfig& physics) {
  return {NewtonSimulator(kScene, {}, physics).push(kStart, 0).end,
          Box2dSimulator(kScene, {}, physics).push(kStart, 0).end};
}

TEST(PhysicsConfig, EachFieldChangesWhereAPushEnds) {
  const testing::OtherValues others{
      {"time_step", 0.1},
      {"sub_steps", 8},
      {"damping", 10},
      {"barrier", 12},
      {"range", 0.1},
      {"skin", 0.01},
      {"sharpness", 30},
      {"slip", 0.05},
      {"force_factor", 3},
      {"torque_factor", 1},
      {"plain_barrier", 1},
      {"inertia", 1},
      {"periodic_turns", 1},
      {"box2d_steps", 4},
      {"box2d_velocity_iterations", 2},
      {"box2d_position_iterations", 1},
  };
  testing::expect_each_field_matters(PhysicsConfig{}, others, {}, ends);
}

}  // namespace
}  // namespace rtg::forward
