#include "core/energy/open_gaps.hpp"

#include <gtest/gtest.h>

#include "core/energy/joint_limit.hpp"
#include "tests/support/chain_scene.hpp"

namespace rtg::energy {
namespace {

using testing::TouchingScene;

VectorXd boxes_apart(double gap) { return stacked({{-5, 0, 0}, {0, 0, 0}, {0.1, 1.2 + gap, 0}}); }

TEST(OpenGaps, LeastGapIsThatOfTheClosestFaces) {
  const TouchingScene scene;
  for (const double gap : {0.1, 0.01, 0.0, -0.004}) {
    // A vertex 0.1 from the other box's corner: rounding adds e^(-0.1 α)/α at most.
    EXPECT_NEAR(least_gap(scene.energy, boxes_apart(gap)), gap, 2e-4) << gap;
  }
  EXPECT_EQ(least_gap(scene.energy, boxes_apart(3.0)), scene.energy.barrier().range);
}

// The door is at its limit but for 0.01 rad, and no two bodies are so close to each other.
TEST(OpenGaps, LeastGapCanBeThatOfALimitOfAJoint) {
  testing::ChainScene scene;
  scene.poses[0].x -= 3.0;
  scene.poses[4].theta = 1.49;
  const VectorXd p = stacked(with_closed_joints(scene.scene, scene.poses));
  double least = INFINITY;
  for_each_limit(scene.energy.scene().articulation(), placed(p),
                 [&](int, const JointLimit<double>& limit) { least = std::min(least, limit.gap); });
  EXPECT_NEAR(least, 0.01 * std::hypot(1.5, 0.15) + JointLimit<double>::kSlack, 1e-9);
  EXPECT_EQ(least_gap(scene.energy, p), least);
}

TEST(OpenGaps, OverlapBySlopIsOpenedByMovingBothBodiesAlike) {
  const TouchingScene scene;
  const VectorXd closed = boxes_apart(-0.005);
  const VectorXd open = with_open_gaps(scene.energy, closed);
  EXPECT_GE(least_gap(scene.energy, open), kGapFloor * scene.energy.barrier().range);
  EXPECT_LT((open - closed).norm(), 0.03);
  EXPECT_NEAR(open[4] - closed[4], closed[7] - open[7], 1e-12);
  EXPECT_EQ(Vector3d(open.head<3>()), Vector3d(closed.head<3>()));
}

// Both corners of a face are in contact. The first one opens half of the second one's gap as well.
TEST(OpenGaps, FacesAreMovedNoFurtherThanNeeded) {
  const TouchingScene scene;
  const double floor = kGapFloor * scene.energy.barrier().range;
  for (const double gap : {-0.005, -0.002, 0.0})
    EXPECT_LT(least_gap(scene.energy, with_open_gaps(scene.energy, boxes_apart(gap))), 1.3 * floor)
        << gap;
}

TEST(OpenGaps, OpenGapsStayBitForBit) {
  const TouchingScene scene;
  for (const double gap : {0.006, 0.1, 3.0})
    EXPECT_EQ(with_open_gaps(scene.energy, boxes_apart(gap)), boxes_apart(gap));
}

TEST(OpenGaps, FixedBodiesStay) {
  TouchingScene scene;
  scene.scene.bodies[2].fixed = true;
  const StepEnergy energy(scene.scene, scene.physics, scene.task.push);
  const VectorXd closed = boxes_apart(-0.005), open = with_open_gaps(energy, closed);
  EXPECT_GE(least_gap(energy, open), kGapFloor * energy.barrier().range);
  EXPECT_EQ(Vector3d(open.tail<3>()), Vector3d(closed.tail<3>()));
}

TEST(OpenGaps, ARowInContactOpensAtEveryJoint) {
  const TouchingScene scene;
  const double reach = 0.8 * std::sqrt(0.75);  // of the hexagon's upper face
  const VectorXd closed = stacked({{0, 0, 0}, {0, reach + 0.597, 0}, {0.1, reach + 1.794, 0}});
  const VectorXd open = with_open_gaps(scene.energy, closed);
  EXPECT_GE(least_gap(scene.energy, open), kGapFloor * scene.energy.barrier().range);
  EXPECT_LT((open - closed).norm(), 0.05);
}

TEST(OpenGaps, OpenJointsAreClosed) {
  testing::ChainScene scene;
  scene.poses[0].x -= 3.0;
  Poses open = with_closed_joints(scene.scene, scene.poses);
  const VectorXd closed = with_open_gaps(scene.energy, stacked(open));
  for (const Joint& joint : scene.scene.joints)
    open[static_cast<std::size_t>(joint.child)].x += 0.002;
  const VectorXd again = with_open_gaps(scene.energy, stacked(open));
  EXPECT_LT((again - closed).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_GT((stacked(open) - closed).lpNorm<Eigen::Infinity>(), 1e-3);
}

// A door whose tip points straight at a wall 2 mm away: no motion that its hinge leaves opens that.
TEST(OpenGaps, StayWhereJointsDoNotLetThemOpen) {
  const Scene scene{{{"robot", "robot", box(1.0, 1.0), 1.0, 0.5, false},
                     {"door", "door", regular_polygon(4, 1.0), 1.0, 0.5, false},
                     {"post", "wall", box(0.2, 0.2), 1.0, 0.5, true},
                     {"wall", "wall", box(1.0, 4.0), 1.0, 0.5, true}},
                    {{2, 1, {0.0, 0.0}, {-1.0, 0.0}}}};
  const StepEnergy energy(scene, {}, {});
  for (const double angle : {0.0, 1e-9, 1e-3}) {
    const VectorXd p =
        stacked(with_closed_joints(scene, {{0, -5, 0}, {0, 0, angle}, {0, 0, 0}, {2.502, 0, 0}}));
    const VectorXd opened = with_open_gaps(energy, p);
    EXPECT_LT((opened - p).lpNorm<Eigen::Infinity>(), 0.1) << angle;
  }
}

}  // namespace
}  // namespace rtg::energy
