// Both forward simulators on jointed bodies.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/energy/implicit_step.hpp"
#include "core/forward/box2d_simulator.hpp"
#include "core/forward/newton_simulator.hpp"
#include "tests/support/chain_scene.hpp"

namespace rtg::forward {
namespace {

using testing::ChainScene;
using testing::closed;
using testing::of_coordinates;
using testing::widest_joint;

const PhysicsConfig kPhysics;
const PushConfig kPush;

/// The robot and a chain of four links, straight along x.
struct Table {
  Scene scene = testing::robot_and_chain();
  Poses start =
      with_closed_joints(scene, {{0, -4, 0}, {-3.6, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
};

/// The action nearest to the heading from the robot to a body, or a few beside it.
int towards(const Poses& poses, std::size_t body, int beside) {
  const Vector2d way = poses[body].position() - poses[0].position();
  const double turns = std::atan2(way.y(), way.x()) / (2.0 * std::numbers::pi);
  return (static_cast<int>(std::lround(turns * kPush.headings)) + 2 * kPush.headings + beside) %
         kPush.headings;
}

// Sixty random pushes at the links in a row, each simulator from where Box2D ended.
TEST(Joints, StayClosedAndWithinTheirLimitsOverAnEpisode) {
  const Table table;
  const Box2dSimulator box2d(table.scene, kPush, kPhysics);
  const NewtonSimulator newton(table.scene, kPush, kPhysics);
  Rng rng(3);
  Poses state = table.start;
  int moved = 0;
  for (int k = 0; k < 60; ++k) {
    const int action = towards(state, 1 + static_cast<std::size_t>(rng.below(4)), rng.below(7) - 3);
    const PushOutcome a = box2d.push(state, action), b = newton.push(state, action);
    ASSERT_TRUE(a.ok && b.ok) << k;
    EXPECT_LT(widest_joint(table.scene, a.end), 1e-4);
    EXPECT_LT(widest_joint(table.scene, b.end), 1e-14);
    for (const Joint& joint : table.scene.joints)
      for (const Poses& end : {a.end, b.end}) {
        const double angle = end[static_cast<std::size_t>(joint.child)].theta -
                             end[static_cast<std::size_t>(joint.parent)].theta;
        EXPECT_LT(std::abs(angle), joint.upper + 0.01) << k;
      }
    moved += (a.end[2].position() - state[2].position()).norm() > 0.05;
    state = a.end;
  }
  EXPECT_GT(moved, 15);
}

// Without contact but with the robot's: the last link swings about its pin as far as in Box2D.
TEST(Joints, APushedLinkSwingsAsInBox2d) {
  const Table table;
  Poses start = table.start;
  start[0] = {3.9, -2.5, 0.0};
  const Poses newton = NewtonSimulator(table.scene, kPush, kPhysics).push(start, 12).end;
  const Poses box2d = Box2dSimulator(table.scene, kPush, kPhysics).push(start, 12).end;
  EXPECT_GT(box2d[4].theta, 0.1);
  for (std::size_t i = 1; i < start.size(); ++i) {
    EXPECT_LT((newton[i].position() - box2d[i].position()).norm(), 0.03) << i;
    EXPECT_NEAR(newton[i].theta, box2d[i].theta, 0.03) << i;
  }
}

/// A door that the robot pushes to its limit and on.
struct Door {
  Scene scene{{testing::gathering().scene.bodies[0],
               {"door", "door", box(1.6, 0.3), 1.0, 0.5, false},
               {"post", "wall", box(0.4, 0.4), 1.0, 0.5, true}},
              {{2, 1, {0.0, 0.3}, {-0.8, 0.0}, -0.5, 0.4}}};
  Poses start = with_closed_joints(scene, {{1.2, -1.2, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}});
};

TEST(Joints, ALimitStopsADoorAndTheRobotThatPushesIt) {
  const Door door;
  const Poses newton = NewtonSimulator(door.scene, kPush, kPhysics).push(door.start, 12).end;
  const Poses box2d = Box2dSimulator(door.scene, kPush, kPhysics).push(door.start, 12).end;
  EXPECT_NEAR(box2d[1].theta, 0.4, 0.02);
  EXPECT_NEAR(newton[1].theta, 0.4, 0.03);
  EXPECT_LT(newton[0].y, 0.0);  // the way is 2 m long
  EXPECT_NEAR(newton[0].y, box2d[0].y, 0.05);
  EXPECT_EQ(newton[2], door.start[2]);
}

TEST(Joints, TheLowerLimitStopsADoorToo) {
  Door door;
  door.scene.joints[0].lower = -0.4;
  door.start[0].y = 1.2;
  const Poses box2d = Box2dSimulator(door.scene, kPush, kPhysics).push(door.start, 36).end;
  EXPECT_NEAR(box2d[1].theta, -0.4, 0.02);
}

TEST(Joints, ALimitStopsADoorThatHasNoLimitOnTheOtherSide) {
  Door upper, lower;
  upper.scene.joints[0].lower = -INFINITY;
  lower.scene.joints[0].lower = -0.4;
  lower.scene.joints[0].upper = INFINITY;
  lower.start[0].y = 1.2;
  for (const auto& [door, action, limit] : {std::tuple(upper, 12, 0.4), {lower, 36, -0.4}}) {
    const NewtonSimulator newton(door.scene, kPush, kPhysics);
    const Box2dSimulator box2d(door.scene, kPush, kPhysics);
    for (const Simulator* simulator :
         {static_cast<const Simulator*>(&newton), static_cast<const Simulator*>(&box2d)})
      EXPECT_NEAR(simulator->push(door.start, action).end[1].theta, limit, 0.03);
  }
}

/// A drawer in a wall, 0.5 m out, in front of the robot, with a block on each side of it. One is
/// welded to it, the other slides on it.
struct Drawer {
  Scene scene{{testing::gathering().scene.bodies[0],
               {"drawer", "drawer", box(1.6, 0.6), 1.0, 0.5, false},
               {"welded", "block", box(0.6, 0.6), 0.5, 0.5, false},
               {"slider", "block", box(0.6, 0.6), 0.5, 0.5, false},
               {"wall", "wall", box(4.0, 0.2), 1.0, 0.5, true}}};
  Poses start;

  Drawer() {
    Joint slides{4, 1, {0.0, 0.5}, {0.0, 0.0}, 0.0, 0.8, JointType::kPrismatic};
    slides.axis = Vector2d::UnitY();
    Joint fixed{1, 2, {-1.2, 0.0}, {0.0, 0.0}};
    fixed.type = JointType::kFixed;
    fixed.angle = 0.3;
    Joint along{1, 3, {1.2, 0.0}, {0.0, 0.0}, -0.1, 1.0, JointType::kPrismatic};
    scene.joints = {slides, fixed, along};
    start = {{0.3, 2.5, 0.0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (const Joint& joint : scene.joints) set_joint_value(joint, 0.0, start);
    set_joint_value(scene.joints[0], 0.5, start);
    start = with_closed_joints(scene, start);
  }
};

/// Largest distance of a body from where its joint is closed, and largest angle [m], [rad].
double widest_opening(const Scene& scene, const Poses& poses) {
  double most = widest_joint(scene, poses);
  for (const Joint& joint : scene.joints)
    most = std::max(most, std::abs(closed_child(joint, poses).theta -
                                   poses[static_cast<std::size_t>(joint.child)].theta));
  return most;
}

TEST(Joints, ADrawerSlidesInUntilItsLimit) {
  const Drawer drawer;
  const Poses newton = NewtonSimulator(drawer.scene, kPush, kPhysics).push(drawer.start, 36).end;
  const Poses box2d = Box2dSimulator(drawer.scene, kPush, kPhysics).push(drawer.start, 36).end;
  for (const Poses& end : {newton, box2d}) {
    EXPECT_NEAR(joint_value(drawer.scene.joints[0], end), 0.0, 0.02);
    EXPECT_LT(widest_opening(drawer.scene, end), 2e-3);
    EXPECT_EQ(end[4], drawer.start[4]);
  }
  EXPECT_LT(widest_opening(drawer.scene, newton), 1e-14);
  EXPECT_NEAR(newton[0].y, box2d[0].y, 0.05);
}

// The robot comes from the right and pushes the block that slides on the drawer.
TEST(Joints, ABlockSlidesOnTheDrawerThatHoldsIt) {
  Drawer drawer;
  drawer.scene.joints[2].lower = -1.0;
  drawer.start[0] = {3.9, 0.9, 0.0};
  const Poses newton = NewtonSimulator(drawer.scene, kPush, kPhysics).push(drawer.start, 24).end;
  const Poses box2d = Box2dSimulator(drawer.scene, kPush, kPhysics).push(drawer.start, 24).end;
  const double far = joint_value(drawer.scene.joints[2], box2d);
  EXPECT_LT(far, -0.2);
  EXPECT_NEAR(joint_value(drawer.scene.joints[2], newton), far, 0.05);
  for (const Poses& end : {newton, box2d}) EXPECT_LT(widest_opening(drawer.scene, end), 2e-3);
}

// Links that are jammed between each other and a wall never come to rest.
TEST(Joints, LinksThatDoNotComeToRestAreReported) {
  Scene scene = testing::robot_and_chain();
  scene.bodies.push_back({"wall", "wall", box(1.0, 4.0), 1.0, 0.5, true});
  const Box2dSimulator simulator(scene, kPush, kPhysics);
  Rng rng(3);
  int restless = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Poses poses;
    for (std::size_t i = 0; i < scene.size(); ++i)
      poses.push_back({rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5), rng.uniform(-3.0, 3.0)});
    const PushOutcome first = simulator.settle(with_closed_joints(scene, poses));
    ASSERT_TRUE(is_finite(first.end));
    restless += !first.ok;
  }
  EXPECT_GT(restless, 0);
  EXPECT_LT(restless, 20);
}

TEST(Joints, AStepEndsWhereTheEnergyOverTheCoordinatesIsLeast) {
  const ChainScene scene;
  const energy::StepEnergy& energy = scene.energy;
  const VectorXd now = energy::stacked(scene.poses), previous_forces = energy.forces(now);
  const Vector3d control(0.4, 0.3, 0.1);
  const auto total = [&](const VectorXd& p) {
    return energy.value(p, {now, previous_forces}) -
           energy.control_bound().dot(control.array().tanh().matrix().cwiseProduct(p.head<3>()));
  };
  const auto step =
      implicit_step(energy, {now, previous_forces}, energy::Drive<double>::controls(control));
  ASSERT_TRUE(step);
  EXPECT_LT(widest_joint(scene.scene, energy::unstacked(step->next)), 1e-14);
  EXPECT_GT((step->next - now).segment<3>(6).norm(), 1e-3);  // a link was pushed
  Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    VectorXd p = step->next;
    p.head(energy.dofs()) += of_coordinates(energy, testing::noise(energy.dofs(), 1e-3, rng));
    EXPECT_GT(total(closed(energy, p)), total(step->next));
  }
}

}  // namespace
}  // namespace rtg::forward
