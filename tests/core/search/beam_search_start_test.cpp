#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <vector>

#include "core/search/beam_search.hpp"
#include "core/search/start_distance.hpp"
#include "tests/support/dragging_world.hpp"

namespace rtg::search {
namespace {

/// Shows how the nodes of a tree look where they are like its target.
struct BeamSearchStartTest : ::testing::Test, testing::DraggingWorld {
  SearchConfig config;
  SearchStats stats;

  BeamSearchStartTest() {
    config.breadth = 12;
    config.whole_plan_share = 0.0;
  }

  /// Returns whether nothing is in the way of what is in place.
  bool has_room(const Poses& poses) const {
    for (const std::size_t k : {0U, 1U, 2U})
      if ((poses[k].position() - task.start[3].position()).norm() < 2.0) return false;
    return legal_state(
        task, snapped_to_start(task, StateMetric(task.scene), poses, task.start, task.start));
  }

  /// The nodes in which box 3 is within 0.4 m of its place.
  std::vector<Poses> nodes_in_place() {
    BeamSearch search(task, config, task.start, 1);
    search.make_roots(replay, stats);
    for (int layer = 0; layer < 20; ++layer) search.grow(solve, replay, stats);
    std::vector<Poses> found;
    for (const Node& n : search.nodes())
      if (n.depth > 0 && (n.poses[3].position() - task.start[3].position()).norm() <= 0.4)
        found.push_back(n.poses);
    return found;
  }

  /// Lists the poses of box 3 in those of nodes_in_place() that have room.
  std::vector<Pose> in_place() {
    std::vector<Pose> found;
    for (const Poses& poses : nodes_in_place())
      if (has_room(poses)) found.push_back(poses[3]);
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

TEST_F(BeamSearchStartTest, TheStartDepthIsTheLeastOfANodeWithAllObjectsInPlaceButForGoals) {
  task.start = {{0, -5, 0}, {-1.3, 0, 0}, {0, 0, 0}, {4.25, 0, 0}};
  Poses target = task.start;
  target[3].y += 0.5;  // another start than the task's
  BeamSearch search(task, config, target, 1);
  search.make_roots(replay, stats);
  EXPECT_EQ(search.start_depth(), -1);
  for (int layer = 0; layer < 20; ++layer) search.grow(solve, replay, stats);
  std::vector<int> depths;
  for (const Node& n : search.nodes()) {
    bool near = n.depth > 0;
    for (std::size_t k = 1; k < n.poses.size(); ++k)
      near = near && (n.poses[k].position() - target[k].position()).norm() <= 0.4;
    if (near) depths.push_back(n.depth);
  }
  ASSERT_FALSE(depths.empty());
  EXPECT_EQ(search.start_depth(), std::ranges::min(depths));
  EXPECT_LT(std::ranges::min(depths), std::ranges::max(depths));
}

TEST_F(BeamSearchStartTest, WithoutJitterItIsWhereTheTargetHasIt) {
  task.start_jitter = 0.0;
  const std::vector<Pose> found = in_place();
  ASSERT_GT(found.size(), 10U);
  for (const Pose& pose : found) EXPECT_EQ(pose, task.start[3]);
}

TEST_F(BeamSearchStartTest, AWideJitterIsCutToAQuarterOfAMetre) {
  task.start_jitter = 1.0;
  double farthest = 0.0;
  for (const Pose& pose : in_place())
    farthest = std::max(
        {farthest, std::abs(pose.x - task.start[3].x), std::abs(pose.y - task.start[3].y)});
  EXPECT_GT(farthest, 0.2);
  EXPECT_LE(farthest, 0.25 + 1e-6);
}

TEST_F(BeamSearchStartTest, WithSomethingInTheWayTheStateStaysAsItIs) {
  task.start_jitter = 0.0;
  testing::add_box(task, task.start[3]);
  task.start.back().x += 1.3;  // where box 3 has no room in its place, but to the left of it
  task.scene.bodies.back().fixed = true;
  config.breadth = 60;
  int stay = 0;
  for (const Poses& poses : nodes_in_place()) {
    EXPECT_TRUE(legal_state(task, poses));
    stay += poses[3] != task.start[3];
  }
  EXPECT_GT(stay, 0);
}

TEST_F(BeamSearchStartTest, WhereNoPlanSucceedsFromThereTheStatesStayAsTheyAre) {
  task.start_jitter = 0.0;
  task.scene.bodies[3].kind = "near";  // it has its goal within 0.4 m of its start
  const tasks::Region beside_its_place =
      tasks::Disc{task.start[3].position() + Vector2d(0.0, 0.3), 0.1};
  task.goal[0].kind = "box";
  task.goal.push_back({"near", tasks::CentreIn{beside_its_place}});
  solve = [this](std::span<const reverse::ReverseJob> jobs) {  // no push moves box 3
    std::vector<reverse::ReverseResult> answers;
    for (const reverse::ReverseJob& job : jobs)
      answers.push_back(dragged(job.action) == 3 ? reverse::ReverseResult{} : predecessors(job));
    return answers;
  };
  // From its start pose, 0.3 m beside its goal, box 3 never gets there.
  const std::vector<Poses> found = nodes_in_place();
  EXPECT_GT(found.size(), 50U) << "the tree grows on";
  for (const Poses& poses : found)
    EXPECT_LE(excess(beside_its_place, poses[3].position()), 0.0) << "where its goal state was";
}

}  // namespace
}  // namespace rtg::search
