#include "core/energy/joint_limit.hpp"

#include <gtest/gtest.h>

#include "tests/support/chain_scene.hpp"

namespace rtg::energy {
namespace {

using testing::ChainScene;

struct Limits {
  ChainScene scene;
  std::vector<JointLimit<double>> all;

  Limits() {
    for_each_limit(scene.energy.scene().articulation(), placed(stacked(scene.poses)),
                   [&](int, const JointLimit<double>& limit) { all.push_back(limit); });
  }
};

// The way of the child's farthest corner to the stop, and the slack.
TEST(JointLimit, GapIsTheWayOfTheTipToTheStop) {
  const Limits limits;
  ASSERT_EQ(limits.all.size(), 6u);
  const double link = std::hypot(2.4, 0.35), door = std::hypot(1.5, 0.15);
  const double angle = limits.scene.poses[3].theta - limits.scene.poses[2].theta;
  EXPECT_NEAR(limits.all[0].gap, link * (angle + 2.4) + 0.02, 1e-12);
  EXPECT_NEAR(limits.all[1].gap, link * (2.4 - angle) + 0.02, 1e-12);
  EXPECT_NEAR(limits.all[2].gap, door * (1.45 + 0.1) + 0.02, 1e-12);
  EXPECT_NEAR(limits.all[3].gap, door * 0.05 + 0.02, 1e-12);
}

TEST(JointLimit, SlopeIsThatOfTheGapOverTheValue) {
  const testing::SliderScene scene;
  for (const JointModel<double>& joint : scene.energy.scene().articulation().joints())
    for (const bool upper : {false, true}) {
      const JointLimit<double> here(joint, upper, 0.1), there(joint, upper, 0.2);
      EXPECT_NEAR(there.gap - here.gap, 0.1 * here.slope, 1e-12);
      EXPECT_EQ(here.slope == 0.0, joint.type == JointType::kFixed);
    }
}

TEST(JointLimit, AJointWithoutLimitsExertsNoForce) {
  ChainScene scene;
  for (Joint& joint : scene.scene.joints) {
    joint.lower = Joint{}.lower;
    joint.upper = Joint{}.upper;
  }
  for (const bool plain : {false, true}) {
    scene.physics.plain_barrier = plain;
    scene.update();
    const VectorXd forces = scene.energy.forces(stacked(scene.poses)).tail(6);
    EXPECT_LT(forces.lpNorm<Eigen::Infinity>(), 1e-8);
  }
}

}  // namespace
}  // namespace rtg::energy
