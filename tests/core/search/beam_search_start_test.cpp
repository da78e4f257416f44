#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/search/beam_search.hpp"
#include "core/search/start_distance.hpp"
#include "tests/support/dragging_world.hpp"

namespace rtg {
namespace {

/// How the nodes of a tree look where they are like its target.
struct BeamSearchStartTest : ::testing::Test, testing::DraggingWorld {
  SearchConfig config;
  SearchStats stats;

  BeamSearchStartTest() {
    config.breadth = 12;
    config.plans = 0.0;
  }

  /// Whether nothing is in the way of what is in place.
  bool has_room(const Poses& poses) const {
    for (const std::size_t k : {0U, 1U, 2U})
      if ((poses[k].position() - task.start[3].position()).norm() < 2.0) return false;
    return legal_state(task, placed(task, StateMetric(task.scene), poses, task.start, task.start));
  }

  /// Poses of box 3 in the nodes in which it is within 0.4 m of its place.
  std::vector<Pose> in_place() {
    BeamSearch search(task, config, task.start, 1);
    search.plant(replay, stats);
    for (int layer = 0; layer < 12; ++layer) search.grow(solve, replay, stats);
    std::vector<Pose> found;
    for (const Node& n : search.nodes())
      if (n.depth > 0 && has_room(n.poses) &&
          (n.poses[3].position() - task.start[3].position()).norm() <= 0.4)
        found.push_back(n.poses[3]);
    return found;
  }
};

TEST_F(BeamSearchStartTest, AnObjectInPlaceIsWhereSomeStartHasIt) {
  task.start_jitter = 0.1;
  const std::vector<Pose> found = in_place();
  ASSERT_GT(found.size(), 10U);
  std::set<double> x;
  for (const Pose& pose : found) {
    EXPECT_LE(std::abs(pose.x - task.start[3].x), 0.1 + 1e-6);
    EXPECT_LE(std::abs(pose.y - task.start[3].y), 0.1 + 1e-6);
    EXPECT_EQ(pose.theta, task.start[3].theta);
    x.insert(pose.x);
  }
  EXPECT_GT(x.size(), found.size() / 2) << "each node has a start of its own";
}

TEST_F(BeamSearchStartTest, WithoutJitterItIsWhereTheTargetHasIt) {
  task.start_jitter = 0.0;
  const std::vector<Pose> found = in_place();
  ASSERT_GT(found.size(), 10U);
  for (const Pose& pose : found) EXPECT_EQ(pose, task.start[3]);
}

}  // namespace
}  // namespace rtg
