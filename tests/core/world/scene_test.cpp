#include "core/world/scene.hpp"

#include <gtest/gtest.h>

#include "core/world/selection.hpp"

#include <cmath>
#include <numbers>

namespace rtg {
namespace {

Body body(const Polygon& shape, double density, double friction = 0.3) {
  return {"", "", shape, density, friction, false};
}

TEST(Scene, MassOfABoxIsTheTextbookOne) {
  const Mass m = mass_of(body(box(1.2, 0.5), 2.5));
  EXPECT_NEAR(m.mass, 2.5 * 0.6, 1e-15);
  EXPECT_NEAR(m.moment, 2.5 * 0.6 * (1.2 * 1.2 + 0.5 * 0.5) / 12.0, 1e-15);
}

TEST(Scene, MassOfARegularPolygonIsTheTextbookOne) {
  for (const int sides : {3, 5, 6, 8}) {
    const double radius = 0.8, half = std::numbers::pi / sides;
    const double area = 0.5 * sides * radius * radius * std::sin(2.0 * half);
    const Mass m = mass_of(body(regular_polygon(sides, radius), 3.0));
    EXPECT_NEAR(m.mass, 3.0 * area, 1e-14);
    const double arm = radius * radius / 6.0 * (1.0 + 2.0 * std::cos(half) * std::cos(half));
    EXPECT_NEAR(m.moment, 3.0 * area * arm, 1e-14);
  }
}

TEST(Scene, MomentIsAboutTheCentroidWhereverTheShapeStands) {
  Polygon shape = box(1.2, 0.5);
  for (Vector2d& v : shape.vertices) v += Vector2d(4.0, -3.0);
  EXPECT_NEAR(mass_of(body(shape, 1.0)).moment, mass_of(body(box(1.2, 0.5), 1.0)).moment, 1e-12);
}

TEST(Scene, FrictionOfAPairIsTheGeometricMean) {
  const Polygon shape = box(1, 1);
  EXPECT_NEAR(pair_friction(body(shape, 1, 0.2), body(shape, 1, 0.8)), 0.4, 1e-15);
  EXPECT_EQ(pair_friction(body(shape, 1, 0.0), body(shape, 1, 0.8)), 0.0);
}

/// A robot, three links, the middle one the root, and one more; joints not in that order.
Scene linked() {
  Scene scene;
  for (const char* name : {"robot", "a", "b", "c", "d"})
    scene.bodies.push_back({name, "link", box(2.0, 0.5), 1.0, 0.5, false});
  scene.joints = {{3, 4, {1, 0}, {-1, 0}}, {2, 3, {1, 0}, {-1, 0}}, {2, 1, {-1, 0}, {1, 0}}};
  return scene;
}

TEST(Scene, RootFirstListsJointsAfterThoseOfTheirParents) {
  EXPECT_EQ(root_first(linked()), (std::vector<std::size_t>{1, 2, 0}));
}

TEST(Scene, AJointTakesTheValueItIsGiven) {
  Joint joint{0, 1, {1.0, 0.5}, {-0.3, 0.2}};
  joint.axis = Vector2d(0.6, 0.8);
  joint.angle = 0.7;
  for (const JointType type : {JointType::kRevolute, JointType::kPrismatic, JointType::kFixed}) {
    joint.type = type;
    Poses poses{{1, 2, 0.5}, {7, 7, -1.0}};
    set_joint_value(joint, 1.3, poses);
    EXPECT_NEAR(joint_value(joint, poses), type == JointType::kFixed ? 0.0 : 1.3, 1e-14);
    EXPECT_LT(joint_gap(joint, poses), 1e-14);
    EXPECT_NEAR(poses[1].theta, type == JointType::kRevolute ? 1.8 : 1.2, 1e-15);
    const Vector2d pin = type == JointType::kPrismatic ? Vector2d(1.78, 1.54) : Vector2d(1.0, 0.5);
    EXPECT_LT((to_world(poses[1], joint.on_child) - to_world(poses[0], pin)).norm(), 1e-14);
  }
}

// A child off its axis goes to the nearest place on it.
TEST(Scene, AClosedSliderKeepsItsPlaceAlongTheAxis) {
  Joint joint{0, 1, {0.0, 1.0}, {0.0, 0.0}, -1.0, 1.0, JointType::kPrismatic};
  const Poses poses{{0, 0, 0}, {2.5, 4.0, 0.3}};
  EXPECT_EQ(closed_child(joint, poses), (Pose{2.5, 1.0, 0.0}));
  EXPECT_EQ(joint_gap(joint, poses), 3.0);
}

TEST(Scene, ClosedJointsLeaveRootsAndAnglesAlone) {
  const Poses poses{{0, 5, 0}, {9, 9, 0.3}, {1, 2, 0.5}, {7, 7, -1.0}, {-4, 0, 2.0}};
  const Poses closed = with_closed_joints(linked(), poses);
  EXPECT_EQ(closed[0], poses[0]);
  EXPECT_EQ(closed[2], poses[2]);
  for (const Joint& joint : linked().joints) {
    EXPECT_LT(joint_gap(joint, closed), 1e-15);
    EXPECT_GT(joint_gap(joint, poses), 1.0);
    const auto child = static_cast<std::size_t>(joint.child);
    EXPECT_EQ(closed[child].theta, poses[child].theta);
  }
}

TEST(Scene, WhatHangsOnAFixedBodyMovesAlone) {
  Scene scene;
  for (const bool fixed : {false, true, false, false, false})
    scene.bodies.push_back({"", "", box(1, 1), 1.0, 0.5, fixed});
  for (const auto& [parent, child] : {std::pair{2, 4}, {1, 2}, {1, 3}})
    scene.joints.push_back({parent, child});
  EXPECT_EQ(roots_of(scene), (std::vector<std::size_t>{0, 1, 1, 1, 1}));
  EXPECT_EQ(moving_group_roots(scene), (std::vector<std::size_t>{0, 1, 2, 3, 2}));
}

TEST(Scene, JointsConnectTheirTwoBodies) {
  EXPECT_TRUE(jointed(linked(), 1, 2));
  EXPECT_TRUE(jointed(linked(), 2, 1));
  EXPECT_FALSE(jointed(linked(), 1, 3));
  EXPECT_FALSE(jointed(linked(), 2, 4));
}

TEST(Scene, ASelectionHasTheJointsBetweenItsBodies) {
  const Selection some = select(linked(), Poses(5), {4, 2, 3});
  EXPECT_EQ(some.scene.joints,
            (std::vector<Joint>{{2, 0, {1, 0}, {-1, 0}}, {1, 2, {1, 0}, {-1, 0}}}));
}

}  // namespace
}  // namespace rtg
