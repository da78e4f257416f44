#include "core/tasks/task.hpp"

#include <gtest/gtest.h>

#include "core/world/separation.hpp"
#include "tests/support/art_manip.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::tasks {
namespace {

using testing::gathering;
using testing::gathering_hard;

Task two_kinds() {
  Task task = gathering();
  task.scene.bodies[1].kind = "a";
  task.goal = {{"a", CentreIn{HalfPlane{{-1.0, 0.0}, -2.0}}},  // x ≥ 2
               {"box", CentreIn{Disc{{0.0, 1.0}, 1.5}}}};
  return task;
}

TEST(Task, GoalIsTheConjunctionOverTheBodiesOfEachKind) {
  const Task task = two_kinds();
  const Poses good{{0, -5, 0}, {2.01, 7, 0}, {0, 2.49, 0}, {1.49, 1, 0}};
  EXPECT_TRUE(succeeded(task, good));
  Poses bad = good;
  bad[1].x = 1.99;
  EXPECT_FALSE(succeeded(task, bad));
  bad = good;
  bad[3].x = 1.51;
  EXPECT_FALSE(succeeded(task, bad));
  bad = good;
  bad[0].x = 100.0;  // the robot is no object
  EXPECT_TRUE(succeeded(task, bad));
}

TEST(Task, AStarMeansMovableObjectsOnly) {
  Task task = gathering();
  task.scene.bodies[3].fixed = true;
  EXPECT_TRUE(succeeded(task, {{0, -5, 0}, {0, 1, 0}, {0, -1, 0}, {7, 7, 0}}));
  EXPECT_FALSE(succeeded(task, {{0, -5, 0}, {0, 2.1, 0}, {0, -1, 0}, {7, 7, 0}}));
}

TEST(Task, BodiesWithARangeStartAnywhereInIt) {
  Task task = gathering();
  task.start_ranges = {StartRange{Polygon{{{-7, -7}, {7, -7}, {7, -4}, {-7, -4}}}, 0.0, 0.0},
                       StartRange{Disc{{-4, 4}, 2.0}, -1.0, 2.0}, std::nullopt, std::nullopt};
  task.layout = task.start;
  Rng rng(1);
  double left = 10.0, right = -10.0, least = 10.0, most = -10.0;
  for (int k = 0; k < 200; ++k) {
    const Poses start = jittered_start(task, 0.1, rng);
    EXPECT_LE((start[1].position() - Vector2d(-4, 4)).norm(), 2.0 + 1e-6);
    EXPECT_LE((start[2].position() - task.start[2].position()).lpNorm<Eigen::Infinity>(), 0.1001);
    EXPECT_EQ(start[2].theta, task.start[2].theta);
    EXPECT_EQ(start[0].theta, 0.0);
    EXPECT_TRUE(start[0].y <= -4.0 && start[0].y >= -7.0);
    EXPECT_FALSE(first_overlap(task.scene, start, kStartClearance));
    left = std::min(left, start[0].x);
    right = std::max(right, start[0].x);
    least = std::min(least, start[1].theta);
    most = std::max(most, start[1].theta);
  }
  EXPECT_TRUE(left < -6.5 && right > 6.5 && least < -0.9 && most > 1.9);
  EXPECT_EQ(jittered_start(task, 0.0, rng)[2], task.start[2]);
}

TEST(Task, JointedBodiesWithARangeStartAsOne) {
  Task task = testing::art_manip();
  task.start_ranges.resize(task.scene.size());
  task.start_ranges[1] = StartRange{Disc{{0, 0}, 3.0}, -3.0, 3.0};
  task.layout = task.start;
  Rng rng(1);
  for (int k = 0; k < 50; ++k) {
    const Poses start = jittered_start(task, 0.0, rng);
    for (const Joint& joint : task.scene.joints) {
      EXPECT_LT(joint_gap(joint, start), 1e-5);
      EXPECT_NEAR(joint_value(joint, start), 0.0, 1e-5);
    }
  }
}

TEST(Task, ObservationHasTheDocumentedNumbers) {
  const Task task = gathering();
  Poses poses = task.start;
  poses[2] = {1.0, -4.0, 0.5};
  const std::vector<float> seen = observation(task, poses);
  ASSERT_EQ(observation_size(task), 20);
  ASSERT_EQ(seen.size(), 20u);
  const float expected[8] = {0.0f,           -1.25f,         0.25f, -1.0f,
                             std::cos(0.5f), std::sin(0.5f), 1.0f,  1.0f};
  for (int k = 0; k < 2; ++k) EXPECT_FLOAT_EQ(seen[k], expected[k]);
  for (int k = 2; k < 8; ++k) EXPECT_FLOAT_EQ(seen[6 + k], expected[k]);
}

TEST(Task, ObservationLeavesOutFixedBodies) {
  Task task = gathering();
  task.scene.bodies[1].fixed = true;
  EXPECT_EQ(observation_size(task), 14);
  EXPECT_EQ(observation(task, task.start).size(), 14u);
}

TEST(Task, JitteredStartsStayWithinTheAmplitudeAndFreeOfOverlap) {
  const Task task = gathering();
  Rng rng(3);
  double widest = 0.0;
  for (int k = 0; k < 200; ++k) {
    const Poses poses = jittered_start(task, 0.5, rng);
    EXPECT_EQ(poses[0], task.start[0]);
    EXPECT_EQ(first_overlap(task.scene, poses), std::nullopt);
    for (std::size_t i = 1; i < poses.size(); ++i) {
      const Vector2d moved = poses[i].position() - task.start[i].position();
      widest = std::max(widest, moved.cwiseAbs().maxCoeff());
      EXPECT_EQ(poses[i].theta, task.start[i].theta);
      EXPECT_EQ(poses[i], to_single(poses[i]));
    }
  }
  EXPECT_LE(widest, 0.5 + 1e-6);
  EXPECT_GT(widest, 0.45);
}

// Moved by up to 6 m, a box leaves the arena of 8 m in most draws.
TEST(Task, JitteredStartsKeepObjectsInTheArena) {
  const Task task = gathering();
  Rng rng(7);
  for (int k = 0; k < 100; ++k)
    for (const Pose& pose : jittered_start(task, 6.0, rng)) EXPECT_TRUE(in_arena(pose, task.push));
}

// The second box stands 3.461 m from the centre: a quarter of the states within 0.5 m of the start
// are solved.
TEST(Task, JitteredStartsAreNeverInTheGoal) {
  Task task = gathering();
  task.goal = testing::near_origin(3.46);
  ASSERT_FALSE(succeeded(task, task.start));
  Rng rng(6);
  for (int k = 0; k < 200; ++k) EXPECT_FALSE(succeeded(task, jittered_start(task, 0.5, rng)));
}

TEST(Task, JitterDrawsOverlapsAgainAndGivesUpOnTheImpossible) {
  Task task = gathering();
  Rng rng(4);
  task.start[2] = {-3.0 + 1.4, 1.13, 0.2};
  for (int k = 0; k < 50; ++k)
    EXPECT_EQ(first_overlap(task.scene, jittered_start(task, 1.0, rng), 0.02), std::nullopt);
  task.scene.bodies[1].fixed = task.scene.bodies[2].fixed = task.scene.bodies[3].fixed = true;
  task.scene.bodies[3].fixed = false;
  task.start[3] = task.start[2];
  EXPECT_THROW(jittered_start(task, 0.01, rng), std::invalid_argument);
  EXPECT_FALSE(allows_jitter(task, 0.01));
}

TEST(Task, WhatKeepsStartsFromBeingLegalIsNamed) {
  const auto reason = [](const Task& task, double amplitude) {
    Refusals refusals;
    Rng rng(4);
    EXPECT_FALSE(drawn_start(task, amplitude, rng, &refusals));
    return main_reason(refusals, task.scene);
  };
  Task task = gathering();
  task.start[2] = task.start[1];
  EXPECT_EQ(reason(task, 0.01),
            "'box1' was nearer to 'box2' than the clearance in 100% of the failed tries");
  task = gathering();
  task.start[3].x = 2.0 * task.push.arena;
  EXPECT_EQ(reason(task, 0.01), "'box3' was out of the arena in 100% of the failed tries");
  task = gathering();
  task.goal = testing::near_origin(20.0);
  EXPECT_EQ(reason(task, 0.01), "the goal held in 100% of the failed tries");
}

// Box 1 alone moves, by up to 1 m; the goal holds unless it moves to the right end of that.
TEST(Task, JitterIsAllowedUnlessNearlyNoDrawIsLegal) {
  Task task = gathering();
  task.scene.bodies[2].fixed = task.scene.bodies[3].fixed = true;
  const auto allowed = [&](double share) {
    task.goal = {
        {"*", CentreIn{HalfPlane{Vector2d::UnitX(), task.start[1].x + 1.0 - 2.0 * share}}}};
    return allows_jitter(task, 1.0);
  };
  EXPECT_TRUE(allowed(0.5));
  EXPECT_TRUE(allowed(0.1));
  EXPECT_FALSE(allowed(0.01));  // of 250 draws 2.5 are legal, not 5
  EXPECT_FALSE(allowed(0.002));
}

TEST(Task, ZeroJitterIsTheNominalStart) {
  Rng rng(5);
  EXPECT_EQ(jittered_start(gathering(), 0.0, rng), gathering().start);
}

TEST(Gathering, StartsLegalAndUnsolved) {
  for (const Task& task : {gathering(), gathering_hard()}) {
    EXPECT_EQ(task.scene.size(), task.start.size());
    EXPECT_FALSE(succeeded(task, task.start));
    EXPECT_EQ(first_overlap(task.scene, task.start, 0.02), std::nullopt);
    for (const Body& body : task.scene.bodies)
      EXPECT_EQ(polygon_defect(body.shape.parts()[0].core.vertices), std::nullopt);
    for (const Pose& pose : task.start) EXPECT_EQ(pose, to_single(pose));
  }
  EXPECT_EQ(gathering().scene.size(), 4u);
  EXPECT_EQ(gathering_hard().scene.size(), 5u);
}

}  // namespace
}  // namespace rtg::tasks
