#include "core/search/predecessor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/gathering.hpp"

namespace rtg::search {
namespace {

using testing::gathering;

constexpr double kStep = 1.0 / 64.0;  // [m]; sums of its multiples are exact

/// The state with every body moved by (dx, 0).
Poses shifted(Poses poses, double dx) {
  for (Pose& p : poses) p.x += dx;
  return poses;
}

Poses all_zero() { return Poses(4); }

TEST(ReplayGap, IsTheMeanDistanceOfPositionsOverAllBodies) {
  const Poses a{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, b{{3, 4, 1}, {1, 0, 2}, {1, 1, 3}};
  EXPECT_NEAR(replay_gap(a, b), (5.0 + 0.0 + std::numbers::sqrt2) / 3.0, 1e-15);
}

TEST(ObjectsMoved, CountsObjectsBeyondTheThresholdWithoutTheRobot) {
  Poses next = all_zero();
  next[0].x = 2.0;
  next[1].x = next[1].y = 0.04;  // 0.057 m
  next[2].x = 0.049;
  next[3].theta = 3.0;  // turns do not count
  EXPECT_EQ(objects_moved(all_zero(), next), 1);
  next[3].y = -0.051;
  EXPECT_EQ(objects_moved(all_zero(), next), 2);
}

TEST(LegalState, IsFiniteInTheArenaAndWithoutOverlap) {
  const tasks::Task task = gathering();
  EXPECT_TRUE(legal_state(task, task.start));
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Poses poses = task.start;
    poses[2].theta = bad;
    EXPECT_FALSE(legal_state(task, poses));
  }
  Poses outside = task.start;
  outside[0].y = -8.01;
  EXPECT_FALSE(legal_state(task, outside));
  Poses overlapping = task.start;
  overlapping[1] = overlapping[2];
  EXPECT_FALSE(legal_state(task, overlapping));
}

TEST(Proposals, AreTheConvergedAnswersWithLegalStarts) {
  const tasks::Task task = gathering();
  Poses outside = task.start, overlapping = task.start, moved = task.start;
  outside[0].x = 8.5;
  overlapping[2] = overlapping[3];
  moved[0].x = 0.1;  // no single-precision number
  moved[1].y += 0.5;
  moved[3].y -= 0.5;
  const std::vector<reverse::ReverseJob> jobs{
      {task.start, 3}, {task.start, 4}, {task.start, 5}, {task.start, 6}, {task.start, 7}};
  const std::vector<reverse::ReverseResult> answers{
      {reverse::SolveStatus::kConverged, 9, {outside}},
      {reverse::SolveStatus::kPruned},
      {reverse::SolveStatus::kConverged, 9, {moved, task.start}},
      {reverse::SolveStatus::kLineSearchFailed, 50},
      {reverse::SolveStatus::kConverged, 9, {overlapping}}};
  SearchStats stats;
  std::vector<Predecessor> found;
  for (std::size_t k = 0; k < jobs.size(); ++k)
    for (Predecessor& p : proposals(task, jobs[k], answers[k], 70 + static_cast<int>(k), stats))
      found.push_back(std::move(p));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].parent, 72);
  EXPECT_EQ(found[1].start, task.start);
  EXPECT_EQ(found[0].parent, 72);
  EXPECT_EQ(found[0].action, 5);
  EXPECT_EQ(found[0].wanted_end, task.start);
  EXPECT_EQ(found[0].start[0].x, static_cast<double>(0.1F));
  EXPECT_EQ(found[0].start, to_single(moved));
  EXPECT_EQ(stats.illegal_starts, 2);
}

TEST(Proposals, AreJudgedAfterRounding) {
  tasks::Task task = gathering();
  task.push.arena = 0.1;  // below its single-precision neighbour
  Poses edge = task.start;
  edge[0] = {0.1, 0.0, 0.0};
  ASSERT_TRUE(legal_state(task, edge));
  SearchStats stats;
  const reverse::ReverseResult answer{reverse::SolveStatus::kConverged, 1, {edge}};
  EXPECT_TRUE(proposals(task, {edge, 0}, answer, 0, stats).empty());
  EXPECT_EQ(stats.illegal_starts, 1);
}

TEST(ObjectsMoved, CountsDisplacementsAboveTheThreshold) {
  EXPECT_EQ(objects_moved(all_zero(), shifted(all_zero(), 10 * kStep)), 3);
  EXPECT_EQ(objects_moved(all_zero(), shifted(all_zero(), 3 * kStep)), 0);
}

}  // namespace
}  // namespace rtg::search
