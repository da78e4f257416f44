#include "core/search/start_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;

/// Gathering, its start as the target, all objects in place but the first, which stands 3 m to the
/// right of its place: it has to be pulled to the left.
struct StartDistanceTest : ::testing::Test {
  Task task = gathering();
  StateMetric metric{task.scene};
  Poses poses = task.start;

  StartDistanceTest() { poses[1].x += 3.0; }

  double with_robot_at(double x, double y) {
    poses[0] = {x, y, 0.0};
    return start_distance(task, metric, poses, task.start);
  }
};

// The box is turned by 0.2 rad and reaches 0.71 m to its left, the hexagon 0.8 m to its right.
TEST_F(StartDistanceTest, ARobotReadyToPullHasNoWayToGo) {
  const Pose box = poses[1];
  EXPECT_NEAR(with_robot_at(box.x - 1.55, box.y), 1.5 + 2.0, 1e-12);  // one and a half strides
  EXPECT_NEAR(with_robot_at(box.x + 1.55, box.y), 1.5 + 2.0 + 2.0, 1e-12);  // the wrong side
}

TEST_F(StartDistanceTest, OneStrideFromThereIsOnePushAndLessThanThatIsTwo) {
  const Pose box = poses[1];
  EXPECT_NEAR(with_robot_at(box.x - 3.55, box.y), 1.5 + 2.0 + 1.0, 1e-12);
  EXPECT_NEAR(with_robot_at(box.x - 2.4, box.y), 1.5 + 2.0 + 2.0, 1e-12);
  EXPECT_GT(with_robot_at(box.x - 7.0, box.y), 1.5 + 2.0 + 2.0);
}

TEST_F(StartDistanceTest, WithAllInPlaceTheRobotGoesHome) {
  poses = task.start;
  EXPECT_NEAR(with_robot_at(0.0, -5.0), 0.0, 1e-12);
  EXPECT_NEAR(with_robot_at(0.0, -2.0), 1.5, 1e-12);
}

// Turned by 0.2 rad a box is 0.1 m from its place in the metric, for a stride of 2 m.
TEST_F(StartDistanceTest, ATurnedObjectIsFartherButInPlace) {
  poses = task.start;
  poses[1].theta += 0.2;
  EXPECT_NEAR(with_robot_at(0.0, -5.0), 0.05, 1e-12);
  poses[1].theta = task.start[1].theta + std::acos(-1.0) / 2.0;  // a square
  EXPECT_NEAR(with_robot_at(0.0, -5.0), 0.0, 1e-12);
}

TEST_F(StartDistanceTest, AnObjectLittleOutOfPlaceCountsInPart) {
  poses = task.start;
  poses[1].x += 0.1;
  EXPECT_NEAR(with_robot_at(0.0, -5.0), 0.05 + 2.0 * 0.25, 1e-12);
}

}  // namespace
}  // namespace rtg
