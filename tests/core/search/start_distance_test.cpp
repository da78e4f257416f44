#include "core/search/start_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/art_manip.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::search {
namespace {

using testing::gathering;

/// Gathering, its start as the target, all objects in place but the first, which stands 3 m to the
/// right of its place: it has to be pulled to the left.
struct StartDistanceTest : ::testing::Test {
  tasks::Task task = gathering();
  StateMetric metric{task.scene};
  Poses poses = task.start;

  StartDistanceTest() { poses[1].x += 3.0; }

  double with_robot_at(double x, double y) {
    poses[0] = {x, y, 0.0};
    return start_distance(task, metric, poses, task.start);
  }
  // The pull, going there and its one and a half strides, and the robot's way home from the place.
  double pulled = 2.0 + 1.5;
  double home = (task.start[1].position() - task.start[0].position()).norm() / 2.0;
};

// The box is turned by 0.2 rad and reaches 0.71 m to its left, the hexagon 0.8 m to its right.
TEST_F(StartDistanceTest, ARobotReadyToPullHasNoWayToGo) {
  const Pose box = poses[1];
  EXPECT_NEAR(with_robot_at(box.x - 1.55, box.y), pulled + home, 1e-12);
  EXPECT_NEAR(with_robot_at(box.x + 1.55, box.y), pulled + home + 2.0, 1e-12);  // the wrong side
}

TEST_F(StartDistanceTest, AHeavyObjectTakesMorePushes) {
  metric = StateMetric(task, std::vector{1.0, 0.25, 1.0, 1.0});
  EXPECT_NEAR(with_robot_at(poses[1].x - 1.55, poses[1].y), 2.0 + 1.5 / 0.25 + home, 1e-12);
}

TEST_F(StartDistanceTest, OneStrideFromThereIsOnePushAndLessThanThatIsTwo) {
  const Pose box = poses[1];
  EXPECT_NEAR(with_robot_at(box.x - 3.55, box.y), pulled + home + 1.0, 1e-12);
  EXPECT_NEAR(with_robot_at(box.x - 2.4, box.y), pulled + home + 2.0, 1e-12);
  EXPECT_GT(with_robot_at(box.x - 7.0, box.y), pulled + home + 2.0);
}

TEST_F(StartDistanceTest, WithAllInPlaceTheRobotGoesHome) {
  poses = task.start;
  EXPECT_EQ(with_robot_at(0.0, -5.0), 0.0);
  EXPECT_EQ(with_robot_at(0.2, -5.3), 0.0);  // near enough
  EXPECT_EQ(with_robot_at(0.0, -6.9), 1.0);  // one stride, about
  EXPECT_EQ(with_robot_at(0.0, -4.0), 2.0);  // half a stride takes two
  EXPECT_NEAR(with_robot_at(0.0, 0.0), 2.5, 1e-12);
}

// Turned by 0.2 rad a box is 0.1 m farther from its place in the metric, for a stride of 2 m.
TEST_F(StartDistanceTest, ATurnedObjectIsFartherUnlessItIsInPlace) {
  poses[1].theta += 0.2;
  EXPECT_NEAR(with_robot_at(poses[1].x + 1.55, poses[1].y), pulled + home + 0.05 + 2.0, 1e-12);
  poses[1].theta = task.start[1].theta + std::acos(-1.0) / 2.0;  // a square
  EXPECT_NEAR(with_robot_at(poses[1].x + 1.55, poses[1].y), pulled + home + 2.0, 1e-12);
  poses = task.start;
  poses[1].theta += 0.2;
  EXPECT_EQ(with_robot_at(0.0, -5.0), 0.0);
}

/// Returns |a - b| in strides.
double strides(const Pose& a, const Pose& b) { return (a.position() - b.position()).norm() / 2.0; }

TEST_F(StartDistanceTest, TheRobotGoesHomeFromEachObjectsPlaceAndFromThereToTheNext) {
  poses[2].x += 3.0;
  const Pose robot = task.start[0], box = poses[1];
  const double next = pulled + strides(robot, poses[2]) + strides(task.start[2], robot);
  EXPECT_NEAR(with_robot_at(box.x - 1.55, box.y), pulled + home + next, 1e-12);
}

// Else beams keep the last object, or one far from the next, a little out of its place for ever.
TEST_F(StartDistanceTest, AnObjectThatComesIntoPlaceIsProgressHoweverFarTheRobotGoesThen) {
  task.push.arena = 100.0;
  for (const bool last : {true, false}) {
    poses = task.start;
    (last ? task.start[0] : poses[2]) = {60.0, 60.0, 0.0};
    poses[1].x += 0.45;
    const double before = with_robot_at(poses[1].x - 1.55, poses[1].y);
    poses[1].x -= 0.45;
    const double after = with_robot_at(poses[1].x - 1.55, poses[1].y);
    EXPECT_LT(after, before - 0.5) << last;
  }
}

TEST_F(StartDistanceTest, AnObjectWithinFortyCentimetresIsInPlace) {
  poses = task.start;
  poses[1].x += 0.39;
  EXPECT_EQ(with_robot_at(0.0, -5.0), 0.0);
  poses[1].x += 0.02;
  EXPECT_GT(with_robot_at(0.0, -5.0), 0.2 + 2.0 + 2.0);
}

TEST_F(StartDistanceTest, AllObjectsAreInPlaceWhereverTheRobotIs) {
  EXPECT_FALSE(in_place(metric, poses, task.start));
  for (std::size_t k = 1; k < poses.size(); ++k) {
    poses[k] = task.start[k];
    poses[k].y -= 0.39;
    poses[k].theta += 1.0;
  }
  poses[0] = {7.0, 7.0, 2.0};
  EXPECT_TRUE(in_place(metric, poses, task.start));
  poses[2].y -= 0.02;
  EXPECT_FALSE(in_place(metric, poses, task.start));
}

TEST_F(StartDistanceTest, WhatIsInPlaceIsPutWhereAStartHasIt) {
  Poses start = task.start;
  start[2].x += 0.1;
  poses[2].x -= 0.39;  // 0.49 from there
  poses[2].theta += 1.0;
  poses[0] = {0.1, -4.8, 0.0};  // of no account as long as an object is out of place
  Poses expected = poses;
  expected[2] = start[2];
  EXPECT_EQ(snapped_to_start(task, metric, poses, task.start, start), expected);
  poses[1] = start[1];
  EXPECT_EQ(snapped_to_start(task, metric, poses, task.start, start), start);
  poses[0].y += 0.3;
  expected = start;
  expected[0] = poses[0];
  EXPECT_EQ(snapped_to_start(task, metric, poses, task.start, start), expected);
}

TEST(SnappedToStart, WhatTurnsOnAPinIsInPlaceOnlyIfItIsTurnedRight) {
  tasks::Task task = gathering();
  task.scene.bodies[1].fixed = true;
  task.start[2] = task.start[1];
  task.scene.joints.push_back({1, 2});
  const StateMetric metric(task.scene);
  Poses turned = task.start, nearly = task.start;
  turned[2].theta += 0.9;
  nearly[2].theta += 0.7;  // 0.5 m times that is 0.35 m
  EXPECT_FALSE(in_place(metric, turned, task.start));
  EXPECT_TRUE(in_place(metric, nearly, task.start));
  EXPECT_GT(start_distance(task, metric, turned, task.start), 2.0);
  EXPECT_EQ(snapped_to_start(task, metric, turned, task.start, task.start), turned);
  EXPECT_EQ(snapped_to_start(task, metric, nearly, task.start, task.start), task.start);
}

TEST(SnappedToStart, WhatJointsConnectIsPutThereTogether) {
  const tasks::Task task = testing::art_manip();
  const StateMetric metric(task.scene);
  Poses poses = task.start;
  for (std::size_t i = 1; i < poses.size(); ++i) poses[i].y += 0.3;
  EXPECT_EQ(snapped_to_start(task, metric, poses, task.start, task.start), task.start);
  poses.back().y += 0.3;
  EXPECT_EQ(snapped_to_start(task, metric, poses, task.start, task.start), poses);
}

/// A box above a wall with a gate of 2 m, whose start is below it, and the gate's leaf.
tasks::Task gate() {
  tasks::Task task = gathering();
  const auto set = [&](std::size_t i, const Shape& shape, const Pose& pose, bool fixed) {
    task.scene.bodies[i].shape = shape;
    task.scene.bodies[i].fixed = fixed;
    task.start[i] = pose;
  };
  task.scene.bodies.push_back(task.scene.bodies[3]);
  task.start.emplace_back();
  set(1, box(1.0, 1.0), {4.0, -4.0, 0.0}, false);
  set(2, box(7.0, 0.5), {-4.5, 0.0, 0.0}, true);
  set(3, box(7.0, 0.5), {4.5, 0.0, 0.0}, true);
  set(4, box(1.9, 0.3), {0.0, 0.0, 0.0}, false);
  task.scene.joints = {{2, 4, {3.55, 0.0}, {-0.95, 0.0}}};
  return task;
}

// A leaf that is shut at the start and at the goal has to be opened in between.
TEST(StartDistance, OpeningAGateThatIsInTheWayIsProgress) {
  tasks::Task task = gate();
  task.scene.joints[0].lower = -1.6;
  task.scene.joints[0].upper = 0.1;
  const StateMetric metric(task);
  Poses poses = task.start;
  poses[1] = {0.0, 4.0, 0.0};
  double last = start_distance(task, metric, poses, task.start);
  for (const double angle : {-0.4, -0.8, -1.2}) {
    poses[4].theta = angle;
    poses = with_closed_joints(task.scene, poses);
    const double now = start_distance(task, metric, poses, task.start);
    EXPECT_LT(now, last) << angle;
    last = now;
  }
}

TEST(StartDistance, KnowsTheWayAroundWallsAndThroughAnOpenGate) {
  const tasks::Task task = gate();
  const StateMetric metric(task);
  Poses poses = task.start;
  poses[1] = {-4.0, 4.0, 0.0};
  const double closed = start_distance(task, metric, poses, task.start);
  poses[4].theta = -1.5;
  poses = with_closed_joints(task.scene, poses);
  const double open = start_distance(task, metric, poses, task.start);
  EXPECT_LT(open + 1.0, closed) << "although the leaf is not in its place then";
  const Ways::Way way = metric.way(1, poses, poses[1].position(), task.start[1].position());
  EXPECT_GT(way.length, std::hypot(8.0, 8.0));
  EXPECT_LT(way.length, 14.0);
  EXPECT_EQ(metric.way(4, poses, {0, 0}, {1, 0}).length, 1.0) << "a leaf has no way to go";
}

}  // namespace
}  // namespace rtg::search
