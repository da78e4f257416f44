#include "core/search/beam_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "core/search/start_distance.hpp"
#include "tests/support/dragging_world.hpp"

namespace rtg::search {
namespace {

using testing::moved;

struct BeamSearchTest : ::testing::Test, testing::DraggingWorld {
  SearchConfig config;
  SearchStats stats;
  StateMetric metric{task.scene};

  BeamSearchTest() {
    config.breadth = 6;
    config.plans_per_node = 3;
    config.whole_plan_share = 0.0;
  }

  BeamSearch with_roots(std::uint64_t seed = 1) {
    BeamSearch search(task, config, task.start, seed);
    search.make_roots(replay, stats);
    return search;
  }

  std::vector<double> distances(const BeamSearch& search) const {
    std::vector<double> out;
    for (const int k : search.beam())
      out.push_back(start_distance(task, metric, search.nodes()[k].poses, task.start));
    std::ranges::sort(out);
    return out;
  }
};

// One for every four nodes of a full beam, rounded up.
TEST_F(BeamSearchTest, BeginsAtGoalStatesAtRest) {
  const BeamSearch search = with_roots();
  EXPECT_EQ(search.nodes().size(), 2U);
  EXPECT_EQ(search.beam().size(), 2U);
  for (const Node& n : search.nodes()) {
    EXPECT_TRUE(succeeded(task, n.poses));
    EXPECT_EQ(n.poses, to_single(n.poses));
    EXPECT_EQ(n.depth, 0);
  }
}

TEST_F(BeamSearchTest, GoalsThatComeToRestElsewhereAreCountedAndNoRoots) {
  const ReplayBatch scattering = [](std::span<const ReplayJob> jobs) {
    std::vector<ReplayResult> results;
    for (const ReplayJob& job : jobs) results.push_back({moved(job.start, 1, {9.0, 0.0}), true});
    return results;
  };
  BeamSearch search(task, config, task.start, 1);
  search.make_roots(scattering, stats);
  EXPECT_TRUE(search.nodes().empty() && search.beam().empty());
  EXPECT_EQ(stats.unsettled_goals, 2);
  EXPECT_EQ(search.min_start_distance(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(search.grow(solve, replay, stats).empty());
}

TEST_F(BeamSearchTest, SolvesForEveryActionOfEveryNodeOfTheBeam) {
  BeamSearch search = with_roots();
  for (int layer = 0; layer < 2; ++layer) {
    std::vector<reverse::ReverseJob> expected;
    for (const int node : search.beam())
      for (int action = 0; action < task.push.headings; ++action)
        expected.push_back({search.nodes()[node].poses, action});
    search.grow(solve, replay, stats);
    EXPECT_EQ(asked, expected);
  }
  EXPECT_EQ(stats.candidates, (2 + 6) * 48);
}

TEST_F(BeamSearchTest, TreesThatGrowTogetherGrowAsAlone) {
  config.whole_plan_share = 0.5;
  BeamSearch a = with_roots(1), b = with_roots(2), rootless(task, config, task.start, 3);
  BeamSearch together_a = with_roots(1), together_b = with_roots(2);
  SearchStats alone, together;
  for (int layer = 0; layer < 12; ++layer) {
    std::vector<Transition> expected = a.grow(solve, replay, alone);
    std::ranges::copy(b.grow(solve, replay, alone), std::back_inserter(expected));
    BeamSearch* const trees[] = {&together_a, &rootless, &together_b};
    EXPECT_EQ(BeamSearch::grow_together(trees, solve, replay, together), expected);
  }
  EXPECT_GT(a.nodes().size(), 20U);
  EXPECT_TRUE(std::ranges::equal(together_a.nodes(), a.nodes(), {}, &Node::poses, &Node::poses));
  EXPECT_TRUE(std::ranges::equal(together_b.nodes(), b.nodes(), {}, &Node::poses, &Node::poses));
  EXPECT_EQ(together.gaps, alone.gaps);
  EXPECT_EQ(together.replays, alone.replays);
}

TEST_F(BeamSearchTest, ReturnsTrueStepsThatLeadToAboutANodeOfTheBeam) {
  over = 0.1;  // misses within the tolerance
  config.breadth = 24;
  BeamSearch search = with_roots();
  std::size_t returned = 0;
  for (int layer = 0; layer < 2; ++layer) {  // no object is in place yet
    const std::vector<int> parents(search.beam().begin(), search.beam().end());
    const std::vector<Transition> steps = search.grow(solve, replay, stats);
    EXPECT_LE(steps.size(), 72U) << "three per place in the beam";
    returned += steps.size();
    for (const Transition& t : steps) {
      EXPECT_EQ(t.next, pushed({t.poses, t.action}));
      EXPECT_EQ(t.success, succeeded(task, t.next));
      EXPECT_FALSE(succeeded(task, t.poses));
      EXPECT_EQ(t.source, Source::kTree);
      EXPECT_TRUE(std::ranges::any_of(parents, [&](int k) {
        const Poses& parent = search.nodes()[static_cast<std::size_t>(k)].poses;
        double most = 0.0;
        for (std::size_t i = 0; i < parent.size(); ++i)
          most = std::max(most, (parent[i].position() - t.next[i].position()).norm());
        return most < 0.11;
      }));
    }
    for (const int k : search.beam()) {
      const Node& n = search.nodes()[static_cast<std::size_t>(k)];
      EXPECT_EQ(n.depth > 0, std::ranges::find(steps, n.poses, &Transition::poses) != steps.end());
    }
  }
  EXPECT_GT(returned, 20U);
}

/// Lengths of the plans that the steps are cut into by success; each goes on where it stands.
std::vector<int> plans_of(const tasks::Task& task, const std::vector<Transition>& steps) {
  std::vector<int> lengths;
  for (std::size_t k = 0, first = 0; k < steps.size(); ++k) {
    EXPECT_TRUE(k == first || steps[k].poses == steps[k - 1].next);
    EXPECT_EQ(steps[k].success, succeeded(task, steps[k].next));
    if (!steps[k].success) continue;
    lengths.push_back(static_cast<int>(k - first) + 1);
    first = k + 1;
  }
  EXPECT_TRUE(steps.empty() || steps.back().success);
  return lengths;
}

TEST_F(BeamSearchTest, StoresStepsWithWhatFollowsThemToSuccess) {
  over = 0.05;  // so that no plan goes as it was found
  config.whole_plan_share = 1.0;
  BeamSearch search = with_roots();
  int longest = 0;
  for (int layer = 1; layer <= 5; ++layer) {
    const std::vector<int> lengths = plans_of(task, search.grow(solve, replay, stats));
    ASSERT_FALSE(lengths.empty());
    EXPECT_LE(std::ranges::max(lengths), layer);
    longest = std::max(longest, std::ranges::max(lengths));
    for (const int k : search.beam())
      EXPECT_TRUE(search.nodes()[k].depth == 0 ||
                  std::ranges::count(lengths, search.nodes()[k].depth) > 0);
  }
  EXPECT_GE(longest, 4);
}

TEST_F(BeamSearchTest, AStepWhosePlanDoesNotSucceedIsNeitherKeptNorStored) {
  BeamSearch search = with_roots();
  search.grow(solve, replay, stats);
  // From now on no push brings about what a plan needs.
  const ReplayBatch failing = [&](std::span<const ReplayJob> jobs) {
    std::vector<ReplayResult> results = replay(jobs);
    for (ReplayResult& r : results) r.end = moved(r.end, 1, {5.0, 0.0});
    return results;
  };
  const std::vector<Transition> steps = search.grow(solve, failing, stats);
  EXPECT_TRUE(steps.empty());
  for (const int k : search.beam()) EXPECT_EQ(search.nodes()[static_cast<std::size_t>(k)].depth, 0);
}

TEST_F(BeamSearchTest, DepthIsThatOfTheLayerUnlessTheGoalHoldsBeforeOrAfterTheStep) {
  BeamSearch search = with_roots();
  int deepest = 0;
  for (int layer = 1; layer <= 5; ++layer) {
    const std::vector<Transition> steps = search.grow(solve, replay, stats);
    for (const int k : search.beam()) {
      const Node& n = search.nodes()[static_cast<std::size_t>(k)];
      EXPECT_LE(n.depth, layer);
      EXPECT_EQ(n.depth == 0, succeeded(task, n.poses));
      if (n.depth == 0) continue;
      const auto step = std::ranges::find(steps, n.poses, &Transition::poses);
      ASSERT_NE(step, steps.end());
      EXPECT_EQ(n.depth == 1, step->success);
      deepest = std::max(deepest, n.depth);
    }
  }
  EXPECT_GE(deepest, 3);
}

TEST_F(BeamSearchTest, OfEachSolveTheStartsNearestToTheTargetAreSimulated) {
  drags = {0.2, 0.6, 0.35, testing::kDrag};
  config.predecessors_per_solve = 2;
  config.plans_per_node = 100;  // more than there are steps
  BeamSearch search = with_roots();
  std::size_t best = 0, left_out = 0;
  for (int layer = 0; layer < 3; ++layer) {
    std::set<std::pair<int, double>>
        pushes;  // action and start_distance() of each plan's first push
    bool first = true;
    const ReplayBatch noting = [&](std::span<const ReplayJob> jobs) {
      for (const ReplayJob& job : jobs)
        if (first) pushes.emplace(job.action, start_distance(task, metric, job.start, task.start));
      first = false;
      return replay(jobs);
    };
    search.grow(solve, noting, stats);
    for (std::size_t k = 0; k < asked.size(); ++k) {
      std::vector<double> distances;
      for (const Poses& exact : answered[k].predecessors)
        if (const Poses start = to_single(exact); legal_state(task, start))
          distances.push_back(start_distance(task, metric, start, task.start));
      std::ranges::sort(distances);
      for (std::size_t rank = 0; rank < distances.size(); ++rank) {
        const bool simulated = pushes.contains({asked[k].action, distances[rank]});
        best += rank < 2 && simulated;
        if (rank < 2 || distances[rank] == distances[1]) continue;
        EXPECT_FALSE(simulated);
        ++left_out;
      }
    }
  }
  EXPECT_GT(best, 100U);
  EXPECT_GT(left_out, 200U);
}

TEST_F(BeamSearchTest, GapsAreOfStepsWhoseStartIsTheSolvers) {
  over = 0.1;
  BeamSearch search = with_roots();
  search.grow(solve, replay, stats);
  ASSERT_FALSE(stats.gaps.empty());
  // A push that drags one of the four bodies ends 0.1 m off; the others end as reckoned.
  EXPECT_NEAR(std::ranges::max(stats.gaps), 0.1 / 4, 1e-6);
}

TEST_F(BeamSearchTest, ATreeWithoutPredecessorsHasNoBeam) {
  BeamSearch search = with_roots();
  const SolveBatch none = [](std::span<const reverse::ReverseJob> jobs) {
    return std::vector<reverse::ReverseResult>(jobs.size(), {reverse::SolveStatus::kPruned, 0});
  };
  EXPECT_TRUE(search.grow(none, replay, stats).empty() && search.beam().empty());
  EXPECT_EQ(search.min_start_distance(), std::numeric_limits<double>::infinity());
}

TEST_F(BeamSearchTest, MinStartDistanceIsThatOfTheBeamAndFallsOnTheWay) {
  BeamSearch search = with_roots();
  const double at_first = search.min_start_distance();
  for (int layer = 0; layer < 6; ++layer) {
    EXPECT_EQ(search.min_start_distance(), distances(search)[0]);
    search.grow(solve, replay, stats);
  }
  EXPECT_LT(search.min_start_distance(), at_first - 1.0);
}

TEST_F(BeamSearchTest, NodesAreAFunctionOfTheSeed) {
  const auto nodes = [&](std::uint64_t seed) {
    std::vector<Poses> out;
    BeamSearch search = with_roots(seed);
    for (int layer = 0; layer < 3; ++layer) search.grow(solve, replay, stats);
    std::ranges::transform(search.nodes(), std::back_inserter(out), &Node::poses);
    return out;
  };
  EXPECT_EQ(nodes(1), nodes(1));
  EXPECT_NE(nodes(1), nodes(2));
}

}  // namespace
}  // namespace rtg::search
