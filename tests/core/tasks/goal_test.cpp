#include "core/tasks/goal.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/tasks/goal_sampler.hpp"
#include "core/tasks/task.hpp"
#include "core/world/separation.hpp"
#include "tests/support/art_manip.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/goal_margin.hpp"

namespace rtg::tasks {
namespace {

using testing::art_manip;
using testing::succeeded_with;
using testing::with_margin;

/// The chain at given joint angles, its second link at `x`.
Poses bent(const Task& task, const std::vector<double>& angles, const Vector2d& x) {
  Poses poses = task.start;
  for (std::size_t k = 0; k < angles.size(); ++k)
    poses[k + 2].theta = poses[k + 1].theta + angles[k];
  poses = with_closed_joints(task.scene, poses);
  const Vector2d by = x - poses[2].position();
  for (std::size_t k = 1; k < poses.size(); ++k) {
    poses[k].x += by.x();
    poses[k].y += by.y();
  }
  return poses;
}

TEST(Goal, JointsAreAskedForTheirAngles) {
  const Task task = art_manip();
  const GoalTerm& every = task.goal[0];
  EXPECT_TRUE(holds(every, task, bent(task, {1.32, 1.57, 1.82}, {0, 0})));
  EXPECT_FALSE(holds(with_margin(every, 0.05), task, bent(task, {1.32, 1.57, 1.82}, {0, 0})));
  EXPECT_FALSE(holds(every, task, bent(task, {1.32, 1.84, 1.82}, {0, 0})));
  EXPECT_FALSE(holds(every, task, bent(task, {-1.57, -1.57, -1.57}, {0, 0})));
  GoalTerm one = every;
  one.kind = "link3";
  EXPECT_TRUE(holds(one, task, bent(task, {0.0, 1.57, 0.0}, {0, 0})));
  EXPECT_FALSE(holds(one, task, bent(task, {1.57, 0.0, 1.57}, {0, 0})));
}

TEST(Goal, ACentroidIsTheMeanOfTheCentres) {
  const Task task = testing::gathering();
  const GoalTerm mean{"*", MeanIn{Disc{{0.0, 0.0}, 0.5}}};
  const Poses poses{{0, -5, 0}, {-3, 1, 0}, {3, 1, 0}, {0.9, -2, 0}};
  EXPECT_TRUE(centroid_of(mean, task.scene, poses).isApprox(Vector2d(0.3, 0.0)));
  EXPECT_TRUE(holds(with_margin(mean, 0.19), task, poses));
  EXPECT_FALSE(holds(with_margin(mean, 0.21), task, poses));
}

TEST(Goal, AStarMeansAllBodiesThatMayMove) {
  Task task = testing::gathering();
  task.scene.bodies[2].fixed = true;
  const Poses poses{{0, -5, 0}, {-3, 1, 0}, {30, 1, 0}, {1, -2, 0}};
  const Disc disc{{0.0, 0.0}, 4.0};
  EXPECT_TRUE(holds({"*", CentreIn{disc}}, task, poses));
  const GoalTerm mean{"*", MeanIn{disc}};
  EXPECT_TRUE(centroid_of(mean, task.scene, poses).isApprox(Vector2d(-1.0, -0.5)));
  EXPECT_TRUE(holds(mean, task, poses));
}

TEST(Goal, TheObservationEndsWithTheJointAngles) {
  const Task task = art_manip();
  ASSERT_EQ(observation_size(task), 32);
  const std::vector<float> seen = observation(task, bent(task, {0.5, -1.0, 2.0}, {0, 0}));
  ASSERT_EQ(seen.size(), 32u);
  EXPECT_FLOAT_EQ(seen[26], std::sin(0.5f));
  EXPECT_FLOAT_EQ(seen[27], std::cos(0.5f));
  EXPECT_FLOAT_EQ(seen[28], std::sin(-1.0f));
  EXPECT_FLOAT_EQ(seen[31], std::cos(2.0f));
}

TEST(Goal, JitterMovesAChainAsOne) {
  const Task task = art_manip();
  Rng rng(1);
  for (int draw = 0; draw < 50; ++draw) {
    const Poses poses = jittered_start(task, 0.5, rng);
    const Vector2d by = poses[1].position() - task.start[1].position();
    EXPECT_GT(by.norm(), 0.0);
    for (std::size_t k = 1; k < poses.size(); ++k) {
      EXPECT_LT((poses[k].position() - task.start[k].position() - by).norm(), 1e-6);
      EXPECT_EQ(poses[k].theta, task.start[k].theta);
      EXPECT_EQ(poses[k], to_single(poses[k]));
    }
  }
}

TEST(Goal, SampledGoalsOfAChainHoldAreClosedAndVary) {
  const Task task = art_manip();
  Rng rng(1);
  double least = 10.0, most = -10.0;
  for (int draw = 0; draw < 200; ++draw) {
    const Poses poses = sample_goal(task, rng).value();
    EXPECT_TRUE(succeeded_with(task, poses, 0.049));
    EXPECT_EQ(first_overlap(task.scene, poses, 0.02), std::nullopt);
    for (const Joint& joint : task.scene.joints) EXPECT_LT(joint_gap(joint, poses), 1e-6);
    least = std::min(least, poses[1].theta);
    most = std::max(most, poses[1].theta);
  }
  EXPECT_LT(least, -2.5);
  EXPECT_GT(most, 2.5);
}

TEST(Goal, SampledAnglesKeepToLimitsBeyondHalfATurn) {
  Task task = art_manip();
  task.goal.erase(task.goal.begin());
  for (Joint& joint : task.scene.joints) {
    joint.lower = 4.0;
    joint.upper = 5.5;
  }
  Rng rng(1);
  for (int draw = 0; draw < 20; ++draw) {
    const Poses poses = sample_goal(task, rng).value();
    for (const Joint& joint : task.scene.joints) {
      EXPECT_GE(joint_value(joint, poses), 4.0 - 1e-6);
      EXPECT_LE(joint_value(joint, poses), 5.5 + 1e-6);
    }
  }
}

TEST(Goal, AChainOnAFixedBodyKeepsItsFoot) {
  Task task = art_manip();
  task.scene.bodies[1].fixed = true;
  task.goal.pop_back();
  Rng rng(1);
  EXPECT_EQ(jittered_start(task, 0.5, rng), task.start);
  const Poses poses = sample_goal(task, rng).value();
  EXPECT_EQ(poses[1], task.start[1]);
  for (const Joint& joint : task.scene.joints) EXPECT_LT(joint_gap(joint, poses), 1e-6);
}

TEST(Goal, AFixedBodyMayStandAtTheEdgeOfItsRegion) {
  Task task = testing::gathering();
  task.scene.bodies[3].fixed = true;
  task.scene.bodies[3].kind = "post";
  task.start[3] = to_single({1.97, 0.0, 0.0});
  GoalTerm posts = task.goal[0];
  posts.kind = "post";
  task.goal.push_back(posts);
  Rng rng(1);
  EXPECT_TRUE(sample_goal(task, rng).has_value());
}

}  // namespace
}  // namespace rtg::tasks
