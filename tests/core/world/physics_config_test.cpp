#include "core/world/physics_config.hpp"

#include <gtest/gtest.h>

namespace rtg {
namespace {

// Each sub-step divides the speed of a free body by 1 + k_D.
TEST(PhysicsConfig, ItSettlesUntilAHundredthOfTheSpeedIsLeft) {
  PhysicsConfig physics;
  EXPECT_EQ(physics.settling_steps(), 0);
  physics.inertia = true;
  for (const double damping : {kLeastInertialDamping, 0.3, 1.0, 7.0, 20.0, 98.0, 1e4}) {
    physics.damping = damping;
    const int steps = physics.settling_steps();
    EXPECT_GE(std::pow(1.0 + damping, steps), 100.0) << damping;
    EXPECT_LT(std::pow(1.0 + damping, steps - 1), 100.0) << damping;
  }
}

}  // namespace
}  // namespace rtg
