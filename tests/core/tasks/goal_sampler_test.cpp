#include <gtest/gtest.h>

#include "core/forward/box2d_simulator.hpp"
#include "core/tasks/goal_sampler.hpp"
#include "core/world/separation.hpp"
#include "tests/support/art_manip.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/goal_margin.hpp"

namespace rtg::tasks {
namespace {

using testing::gathering;
using testing::gathering_hard;
using testing::succeeded_with;

constexpr int kGoals = 500;

std::vector<Poses> goals(const Task& task, std::uint64_t seed) {
  std::vector<Poses> out;
  Rng rng(seed);
  for (int k = 0; k < kGoals; ++k) out.push_back(sample_goal(task, rng).value());
  return out;
}

/// Sorting-like: two boxes left of x = -2, one right of x = 2.
Task half_planes() {
  Task task = gathering();
  task.scene.bodies[3].kind = "b";
  task.goal = {{"box", CentreIn{HalfPlane{{1.0, 0.0}, -2.0}}},
               {"b", CentreIn{HalfPlane{{-1.0, 0.0}, -2.0}}}};
  return task;
}

TEST(GoalSampler, GoalsHoldWithRoomToSpareAndDoNotOverlap) {
  Task turned = gathering();
  turned.start[0].theta = 0.25;
  for (const Task& task : {gathering(), gathering_hard(), half_planes(), turned})
    for (const Poses& poses : goals(task, 1)) {
      EXPECT_TRUE(succeeded_with(task, poses, 0.049));
      EXPECT_EQ(first_overlap(task.scene, poses, 0.02), std::nullopt);
      for (const Pose& pose : poses) EXPECT_TRUE(in_arena(pose, task.push));
      EXPECT_EQ(poses[0].theta, task.start[0].theta);
    }
}

// Of 0.2 m a fifth is kept to spare.
TEST(GoalSampler, BringsTheMeanOfLooseBodiesIntoASmallRegion) {
  Task task = gathering();
  task.goal = {{"*", MeanIn{Disc{{0.0, 3.0}, 0.2}}}};
  task.scene.bodies[2].kind = "b";
  task.goal.push_back({"b", CentreIn{HalfPlane{{1.0, 0.0}, -2.0}}});
  for (const Poses& poses : goals(task, 4)) {
    EXPECT_TRUE(succeeded_with(task, poses, 0.039));
    EXPECT_EQ(first_overlap(task.scene, poses, 0.02), std::nullopt);
    for (const Pose& pose : poses) EXPECT_TRUE(in_arena(pose, task.push));
  }
}

TEST(GoalSampler, BringsALinkThatIsNoRootIntoItsRegion) {
  Task task = testing::art_manip();
  task.scene.bodies.back().kind = "tip";
  task.goal = {{"tip", CentreIn{Disc{{3.0, 3.0}, 0.3}}}};
  for (const Poses& poses : goals(task, 5)) EXPECT_TRUE(succeeded_with(task, poses, 0.049));
}

TEST(GoalSampler, BringsTheMeanOfALinkAndALooseBodyIntoASmallRegion) {
  Task task = testing::art_manip();
  task.scene.bodies.push_back({"box", "tip", box(1.0, 1.0), 1.0, 0.5, false});
  task.start.push_back({6.0, 6.0, 0.0});
  task.scene.bodies[4].kind = "tip";
  task.goal = {{"tip", MeanIn{Disc{{0.0, 0.0}, 0.2}}}};
  for (const Poses& poses : goals(task, 6)) EXPECT_TRUE(succeeded_with(task, poses, 0.039));
}

TEST(GoalSampler, SettledGoalsStillHold) {
  const Task task = gathering();
  const forward::Box2dSimulator simulator(task.scene, task.push, PhysicsConfig{});
  int held = 0;
  for (const Poses& poses : goals(task, 2)) {
    const forward::PushOutcome rest = simulator.settle(poses);
    held += rest.ok && succeeded_with(task, rest.end, 0.04);
  }
  RecordProperty("held", held);
  EXPECT_EQ(held, kGoals);
}

TEST(GoalSampler, LayoutsVaryFromClustersToSpreadOnes) {
  const Task task = gathering();
  int touching = 0, apart = 0, robot_near = 0;
  for (const Poses& poses : goals(task, 3)) {
    Scene objects{{task.scene.bodies.begin() + 1, task.scene.bodies.end()}};
    const bool close = first_overlap(objects, {poses.begin() + 1, poses.end()}, 0.1).has_value();
    (close ? touching : apart)++;
    robot_near += first_overlap(task.scene, poses, 0.06).has_value() && !close;
  }
  EXPECT_GT(touching, kGoals / 5);
  EXPECT_GT(apart, kGoals / 10);
  EXPECT_GT(robot_near, apart / 2);
}

TEST(GoalSampler, EqualSeedsGiveEqualGoalsAndOthersDoNot) {
  EXPECT_EQ(goals(gathering(), 7), goals(gathering(), 7));
  EXPECT_NE(goals(gathering(), 7), goals(gathering(), 8));
}

TEST(GoalSampler, AnImpossibleGoalIsReported) {
  Task task = gathering();
  task.goal = testing::near_origin(0.4);  // three boxes do not fit
  Rng rng(1);
  EXPECT_EQ(sample_goal(task, rng), std::nullopt);
}

}  // namespace
}  // namespace rtg::tasks
