#include "core/search/stretch_probe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/search/beam_search.hpp"
#include "core/search/simulators.hpp"
#include "tests/support/art_manip.hpp"
#include "tests/support/dragging_world.hpp"
#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;

/// A task with nothing but the robot: the distance of two states is that of their positions.
Task lonely() {
  Task task = gathering();
  task.scene.bodies.resize(1);
  task.start.resize(1);
  return task;
}

/// Replays with `push`, keeping count.
template <class Push>
ReplayBatch replay_by(Push push, std::vector<ReplayJob>& asked) {
  return [push, &asked](std::span<const ReplayJob> jobs) {
    asked.insert(asked.end(), jobs.begin(), jobs.end());
    std::vector<ReplayResult> results;
    for (const ReplayJob& job : jobs) results.push_back({push(job.start), true, 0.0});
    return results;
  };
}

Poses same(const Poses& poses) { return poses; }

Predecessor moving(const Poses& start, const Poses& end, int action = 7) {
  return {0, action, start, end, 1};
}

TEST(StretchProbe, IsTheRatioOfTheErrorsAfterAndBefore) {
  const Task task = lonely();
  const auto thrice = [](Poses poses) {
    poses[0] = {3.0 * poses[0].x, 3.0 * poses[0].y, 0.0};
    return poses;
  };
  std::vector<ReplayJob> asked;
  SearchStats stats;
  std::vector<Predecessor> candidates{moving(task.start, thrice(task.start))};
  StretchProbe(task, {}, 1).measure(candidates, replay_by(thrice, asked), stats);
  EXPECT_NEAR(candidates[0].stretch, 3.0, 1e-4);  // embeddings have single precision, 1e-6 of 15 m
}

TEST(StretchProbe, TwinsOfAChainAreClosedAndWithinItsLimits) {
  Task task = testing::art_manip();
  task.scene.joints[0].lower = -0.01;
  SearchConfig config;
  config.twins = 20;
  std::vector<ReplayJob> asked;
  SearchStats stats;
  std::vector<Predecessor> candidates{moving(task.start, task.start)};
  StretchProbe(task, config, 1).measure(candidates, replay_by(same, asked), stats);
  ASSERT_EQ(asked.size(), 20U);
  double turn = 0.0;
  for (const ReplayJob& job : asked) {
    for (const Joint& joint : task.scene.joints) EXPECT_LT(joint_gap(joint, job.start), 1e-5);
    EXPECT_GE(joint_angle(task.scene.joints[0], job.start), -0.01 - 1e-6);
    for (std::size_t body = 1; body < job.start.size(); ++body)
      turn = std::max(turn, std::abs(job.start[body].theta));
  }
  EXPECT_GT(turn, 0.03);
  EXPECT_LT(turn, 0.2);
}

TEST(StretchProbe, TwinsAreDisturbedByNoMoreThanTheJitter) {
  Task task = gathering();
  task.scene.bodies[3].fixed = true;
  SearchConfig config;
  config.twins = 20;
  config.twin_jitter = 0.2;
  std::vector<ReplayJob> asked;
  SearchStats stats;
  std::vector<Predecessor> candidates{moving(task.start, task.start)};
  StretchProbe(task, config, 1).measure(candidates, replay_by(same, asked), stats);
  ASSERT_EQ(asked.size(), 20U);
  double way = 0.0, turn = 0.0;
  for (const ReplayJob& job : asked) {
    EXPECT_EQ(job.action, 7);
    EXPECT_TRUE(legal_state(task, job.start));
    EXPECT_EQ(job.start[0].theta, task.start[0].theta);  // every push holds the robot's heading
    EXPECT_EQ(job.start[3], to_single(task.start[3]));
    for (std::size_t body = 0; body < job.start.size(); ++body) {
      way = std::max({way, std::abs(job.start[body].x - task.start[body].x),
                      std::abs(job.start[body].y - task.start[body].y)});
      turn = std::max(turn, std::abs(job.start[body].theta - task.start[body].theta));
    }
  }
  const double rounding = 1e-6;  // of states to single precision
  EXPECT_LE(way, 0.2 + rounding);
  EXPECT_GT(way, 0.1);
  EXPECT_LE(turn, 0.2 / 1.5 + rounding);
  EXPECT_GT(turn, 0.1 / 1.5);
  EXPECT_DOUBLE_EQ(candidates[0].stretch, 1.0);  // a push that changes nothing
}

TEST(StretchProbe, LeavesPushesThatMissTheirEndOrTurnAnObject) {
  const Task task = gathering();
  std::vector<Predecessor> candidates(2, moving(task.start, task.start));
  candidates[0].turn = SearchConfig{}.turn_tolerance + 0.01;
  candidates[1].miss = SearchConfig{}.gap_tolerance + 0.01;
  std::vector<ReplayJob> asked;
  SearchStats stats;
  StretchProbe(task, {}, 1).measure(candidates, replay_by(same, asked), stats);
  EXPECT_TRUE(asked.empty());
  EXPECT_EQ(candidates[0].stretch, 1.0);
  EXPECT_EQ(candidates[1].stretch, 1.0);
}

TEST(StretchProbe, LooksAtAMissThatReachesTheGoal) {
  const Task task = gathering();
  const Poses goal{{0, -3, 0}, {-1.3, 0, 0}, {0, 0, 0}, {1.3, 0, 0}};
  ASSERT_TRUE(succeeded(task, goal));
  std::vector<Predecessor> candidates{moving(task.start, goal)};
  candidates[0].miss = SearchConfig{}.gap_tolerance + 0.01;
  std::vector<ReplayJob> asked;
  SearchStats stats;
  StretchProbe(task, {}, 1).measure(candidates, replay_by(same, asked), stats);
  EXPECT_EQ(asked.size(), SearchConfig{}.twins);
}

TEST(StretchProbe, CountsTwinsThatTheSimulatorRejects) {
  const Task task = gathering();
  const ReplayBatch rejecting = [](std::span<const ReplayJob> jobs) {
    return std::vector<ReplayResult>(jobs.size(), {{}, false, 0.0});
  };
  std::vector<Predecessor> candidates{moving(task.start, task.start)};
  SearchStats stats;
  StretchProbe(task, {}, 1).measure(candidates, rejecting, stats);
  EXPECT_EQ(stats.rejected_pushes, SearchConfig{}.twins);
  EXPECT_EQ(candidates[0].stretch, 1.0);
}

TEST(StretchProbe, WhatStretchesErrorsByMoreThanTheToleranceIsReturnedButNotExpanded) {
  for (const double stretch : {1.0 / 1.5, 1.5})
    for (const double share : {0.9, 1.1}) {  // room for the errors of angles, which it keeps
      testing::DraggingWorld world;
      world.stretch = stretch;
      SearchConfig config;
      config.breadth = 6;
      config.stretch_tolerance = share * stretch;
      SearchStats stats;
      BeamSearch search(world.task, config, 1);
      search.aim({world.task.start}, config.breadth, world.replay, stats);
      const std::size_t roots = search.nodes().size();
      EXPECT_GT(search.grow(world.solve, world.replay, stats).size(), 3U);
      EXPECT_EQ(search.nodes().size() > roots, share > 1.0) << stretch << ", " << share;
    }
}

/// Stretch of a push along `action` of a box that faces it, half a metre ahead.
double stretch_of_push(int action) {
  Task task = gathering();
  const Vector2d d = direction(action, task.push);
  Poses start{
      {0, 0, 0}, {2.0 * d.x(), 2.0 * d.y(), std::atan2(d.y(), d.x())}, {-5, 5, 0}, {-5, -5, 0}};
  const ReplayBatch replay = in_process_seams(reverse_solver(task, {}, {}, ReverseMode::kNaive),
                                              forward_replay(task, {}), 1)
                                 .replay;
  SearchConfig config;
  config.twins = 50;
  config.twin_jitter = 0.1;
  SearchStats stats;
  const std::vector<ReplayJob> push{{start, action}};
  std::vector<Predecessor> candidates{moving(start, replay(push)[0].end, action)};
  StretchProbe(task, config, 1).measure(candidates, replay, stats);
  return candidates[0].stretch;
}

TEST(StretchProbe, TellsACornerThatLosesABoxFromAFaceThatHoldsIt) {
  EXPECT_LT(stretch_of_push(4), 1.0);  // 30°: face to face, the box comes to lie against it
  EXPECT_GT(stretch_of_push(0), 1.5);  // 0°: a corner on the middle of a face
}

}  // namespace
}  // namespace rtg
