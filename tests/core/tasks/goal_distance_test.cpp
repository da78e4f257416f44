#include "core/tasks/goal_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/art_manip.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::tasks {
namespace {

constexpr double kRobotWeight = 0.2;

TEST(GoalDistance, IsHowFarTheObjectsAreFromTheirDiscAndTheDistanceToTheNearestOfThese) {
  const Task task = testing::gathering();  // centres within 2 m of the origin
  const Poses poses{{0.0, -5.0, 0.0}, {3.0, 0.0, 0.0}, {0.0, 4.0, 0.0}, {0.0, -1.0, 0.0}};
  const double robot_distance = std::hypot(3.0, 5.0);  // to the first: the third is in its place
  EXPECT_NEAR(goal_distance(task, poses), 1.0 + 2.0 + kRobotWeight * robot_distance, 1e-12);
}

TEST(GoalDistance, IsZeroWhereTheGoalHolds) {
  const Task task = testing::gathering();
  EXPECT_EQ(goal_distance(task, {{5, 5, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1.5, 0}}), 0.0);
}

TEST(GoalDistance, OfAHalfPlaneIsThatFromItsLine) {
  Task task = testing::gathering();
  task.goal = {{"*", CentreIn{HalfPlane{{0.0, 1.0}, -1.0}}}};
  const Poses poses{{0, 0, 0}, {0, 1, 0}, {4, -1, 0}, {4, -2, 0}};
  EXPECT_NEAR(goal_distance(task, poses), 2.0 + kRobotWeight * 1.0, 1e-12);
}

TEST(GoalDistance, OfJointsAndAMeanCentreIsOfAnglesAndOfTheMean) {
  const Task task = testing::art_manip();  // 75 to 105 degrees, within 1 m of (0, 3)
  const double least = 1.309, off = 3.0 - 1.0;
  double robot_distance = 1e9;
  for (std::size_t k = 1; k < task.start.size(); ++k)
    robot_distance =
        std::min(robot_distance, (task.start[k].position() - task.start[0].position()).norm());
  EXPECT_NEAR(goal_distance(task, task.start), 3.0 * least + off + kRobotWeight * robot_distance,
              1e-9);
}

TEST(GoalDistance, OfAJointIsTheDistanceToTheNearerOfItsTwoBodies) {
  Task task = testing::art_manip();  // 75 to 105 degrees at each joint
  std::erase_if(task.goal,
                [](const GoalTerm& t) { return !std::holds_alternative<JointIn>(t.condition); });
  Poses poses{{0, 0, 0}, {1, 0, 0.0}, {3, 0, 0.0}, {9, 9, 1.5}, {9, 9, 3.0}};
  const double expected = 75.0 * std::numbers::pi / 180.0 + kRobotWeight * 1.0;
  for (int order = 0; order < 2; ++order) {
    EXPECT_NEAR(goal_distance(task, poses), expected, 1e-3);
    std::swap(poses[1].x, poses[2].x);
  }
}

}  // namespace
}  // namespace rtg::tasks
