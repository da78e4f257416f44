#include "core/search/beam_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "tests/support/dragging_world.hpp"

namespace rtg {
namespace {

using testing::moved;

constexpr Ranking kAllRankings[]{Ranking::kStartDistance, Ranking::kNovelty,
                                 Ranking::kDisplacement};

struct BeamSearchTest : ::testing::Test, testing::DraggingWorld {
  SearchConfig config;
  SearchStats stats;
  StateMetric metric{task.scene};

  BeamSearchTest() { config.breadth = 6; }

  BeamSearch aimed(std::uint64_t seed = 1) {
    BeamSearch search(task, config, seed);
    search.aim({task.start}, config.breadth, replay, stats);
    return search;
  }

  std::vector<double> distances(const BeamSearch& search, std::span<const int> of,
                                const Poses& target) const {
    std::vector<double> out;
    for (const int k : of)
      out.push_back(start_distance(task, metric, search.nodes()[k].poses, {target}));
    std::ranges::sort(out);
    return out;
  }
};

/// Indices of all nodes.
std::vector<int> everything(const BeamSearch& search) {
  std::vector<int> out;
  for (std::size_t k = 0; k < search.nodes().size(); ++k) out.push_back(static_cast<int>(k));
  return out;
}

TEST_F(BeamSearchTest, BeginsAtGoalStatesAtRest) {
  const BeamSearch search = aimed();
  EXPECT_EQ(search.nodes().size(), 6U);
  EXPECT_EQ(search.beam().size(), 6U);
  for (const Node& n : search.nodes()) {
    EXPECT_TRUE(succeeded(task, n.poses));
    EXPECT_EQ(n.poses, float_rounded(n.poses));
    EXPECT_EQ(n.parent, -1);
    EXPECT_EQ(n.depth, 0);
  }
}

TEST_F(BeamSearchTest, GoalsThatComeToRestElsewhereAreCountedNotPlanted) {
  const ReplayBatch scattering = [](std::span<const ReplayJob> jobs) {
    std::vector<ReplayResult> results;
    for (const ReplayJob& job : jobs) results.push_back({moved(job.start, 1, {9.0, 0.0}), true});
    return results;
  };
  BeamSearch search(task, config, 1);
  search.aim({task.start}, config.breadth, scattering, stats);
  EXPECT_TRUE(search.nodes().empty());
  EXPECT_TRUE(search.beam().empty());
  EXPECT_EQ(stats.unsettled_goals, 6);
  EXPECT_EQ(search.best(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(search.grow(solve, replay, stats).empty());
}

TEST_F(BeamSearchTest, SolvesForEveryActionOfEveryNodeOfTheBeam) {
  BeamSearch search = aimed();
  for (int layer = 0; layer < 2; ++layer) {
    std::vector<ReverseJob> expected;
    for (const int node : search.beam())
      for (int action = 0; action < task.push.headings; ++action)
        expected.push_back({search.nodes()[node].poses, action});
    search.grow(solve, replay, stats);
    EXPECT_EQ(asked, expected);
  }
  EXPECT_EQ(stats.candidates, 2 * 6 * 48);
}

TEST_F(BeamSearchTest, DepthIsOneMoreThanTheParentsUnlessTheGoalHoldsBeforeOrAfterTheStep) {
  BeamSearch search = aimed();
  const auto expected = [&](int parent, const Poses& start, const Poses& end) {
    const int after = succeeded(task, end) ? 0 : search.nodes()[parent].depth;
    return succeeded(task, start) ? 0 : after + 1;
  };
  int deepest = 0;
  for (int layer = 0; layer < 5; ++layer)
    for (const BeamSearch::Growth& g : search.grow(solve, replay, stats))
      EXPECT_EQ(g.depth, expected(g.candidate.parent, g.candidate.start, g.candidate.end));
  for (const Node& n : search.nodes()) {
    if (n.parent >= 0) {
      EXPECT_EQ(n.depth, expected(n.parent, n.poses, pushed({n.poses, n.action})));
    }
    deepest = std::max(deepest, n.depth);
  }
  EXPECT_GE(deepest, 3);
}

TEST_F(BeamSearchTest, AMissThatReachesTheGoalIsOneActionFromSuccess) {
  over = 0.24;  // within the tolerance; goal states lie 0.05 m within the goal, and more
  config.breadth = 60;
  BeamSearch search = aimed();
  for (int layer = 0; layer < 5; ++layer) search.grow(solve, replay, stats);
  int hits = 0;
  for (const int k : everything(search)) {
    const Node& n = search.nodes()[k];
    if (n.depth != 1 || search.nodes()[n.parent].depth == 0) continue;
    EXPECT_EQ(search.chain(k).actions, std::vector{n.action});
    hits += succeeded(task, pushed({n.poses, n.action}));
  }
  EXPECT_GT(hits, 0);
}

TEST_F(BeamSearchTest, ChainsReplayToSuccessInAsManyActionsAsTheNodeIsDeep) {
  BeamSearch search = aimed();
  for (int layer = 0; layer < 6; ++layer) search.grow(solve, replay, stats);
  std::vector<Chain> chains;
  for (const int k : everything(search)) chains.push_back(search.chain(k));
  const auto replayed = replay_chains(task, chains, replay, stats);
  int long_ones = 0;
  for (std::size_t k = 0; k < chains.size(); ++k) {
    const auto depth = static_cast<std::size_t>(search.nodes()[k].depth);
    EXPECT_EQ(chains[k].far_end, search.nodes()[k].poses);
    ASSERT_EQ(chains[k].actions.size(), depth);
    ASSERT_EQ(replayed[k].size(), depth) << "the goal holds too early";
    if (depth > 0) {
      EXPECT_TRUE(replayed[k].back().success);
    }
    long_ones += depth >= 3;
  }
  EXPECT_GT(long_ones, 5);
}

TEST_F(BeamSearchTest, WhatMissesByMoreThanTheToleranceIsReturnedButNotExpanded) {
  for (const double off : {0.2, 0.3}) {  // of the robot alone: a gap of a quarter of that
    aside = off;
    config.gap_tolerance = 0.25;
    BeamSearch search = aimed();
    int returned = 0, expanded = 0;
    for (int layer = 0; layer < 3; ++layer)
      for (const BeamSearch::Growth& g : search.grow(solve, replay, stats)) {
        EXPECT_NEAR(g.candidate.miss, misses(g.candidate.action) ? off : 0.0, 1e-5);
        returned += misses(g.candidate.action);
      }
    for (const Node& n : search.nodes()) expanded += n.parent >= 0 && misses(n.action);
    EXPECT_GT(returned, 20);
    EXPECT_EQ(expanded > 0, off < config.gap_tolerance);
  }
}

TEST_F(BeamSearchTest, WhatTurnsAnObjectByMoreThanTheToleranceIsReturnedButNotExpanded) {
  config.turn_tolerance = 0.25;
  for (const double by : {-0.2, 0.2, 0.3, -0.3}) {
    BeamSearch search = aimed();
    turn = by;
    int returned = 0, expanded = 0;
    for (int layer = 0; layer < 3; ++layer)
      for (const BeamSearch::Growth& g : search.grow(solve, replay, stats)) {
        EXPECT_NEAR(g.candidate.turn, dragged(g.candidate.action) ? std::abs(by) : 0.0, 1e-6);
        returned += dragged(g.candidate.action) != 0;
      }
    for (const Node& n : search.nodes()) expanded += n.parent >= 0 && dragged(n.action) != 0;
    EXPECT_GT(returned, 20);
    EXPECT_EQ(expanded > 0, std::abs(by) < config.turn_tolerance);
  }
}

/// Scores of pushes by what the limits on replays count: (node, action) for those that move an
/// object, (node, -1) for those that do not.
using Scores = std::map<std::pair<int, int>, std::vector<double>>;

struct WorthReplayingTest : BeamSearchTest {
  WorthReplayingTest() {
    config.free_moves = 5;
    config.starts = 2;
    drags = {0.2, 0.6, 0.35, testing::kDrag};
  }

  void note(Scores& scores, const Score& score, int node, const Predecessor& c) const {
    const bool idle = objects_moved(c.start, c.end) == 0;
    scores[{node, idle ? -1 : c.action}].push_back(score(c));
  }

  /// All legal starts of the last layer's answers, `parents` the beam it grew from.
  Scores offered(const BeamSearch& search, const Score& score, std::span<const int> parents) const {
    Scores scores;
    for (std::size_t k = 0; k < asked.size(); ++k)
      for (const Poses& exact : answered[k].starts) {
        const int node = *std::ranges::find_if(
            parents, [&](int p) { return search.nodes()[p].poses == asked[k].end; });
        const Poses start = float_rounded(exact);
        if (legal_state(task, start))
          note(scores, score, node, {0, asked[k].action, start, asked[k].end});
      }
    return scores;
  }
};

TEST_F(WorthReplayingTest, OfAllStartsTheBestPerNodeAndPerSolveAreReplayed) {
  for (const Ranking ranking : {Ranking::kStartDistance, Ranking::kDisplacement}) {
    config.ranking = ranking;
    const Score score = make_score(ranking, task, {task.start}, {});
    BeamSearch search = aimed();
    int left_out = 0;
    for (int layer = 0; layer < 3; ++layer) {
      const std::vector<int> parents(search.beam().begin(), search.beam().end());
      Scores kept;
      for (const auto& [c, depth] : search.grow(solve, replay, stats))
        note(kept, score, c.parent,
             {0, c.action, c.start, search.nodes()[static_cast<std::size_t>(c.parent)].poses});
      Scores best = offered(search, score, parents);
      for (auto& [key, scores] : best) {
        std::ranges::sort(scores);
        const std::size_t limit = key.second < 0 ? 5 : 2;
        left_out += scores.size() > limit;
        scores.resize(std::min(scores.size(), limit));
        std::ranges::sort(kept[key]);
      }
      EXPECT_EQ(kept, best);
    }
    EXPECT_GT(left_out, 200);  // of 18 nodes and their 24 solves that move an object
  }
}

TEST_F(WorthReplayingTest, NoFreeMoveIsReplayedWhereNoneIsAllowed) {
  config.free_moves = 0;
  BeamSearch search = aimed();
  const auto growths = search.grow(solve, replay, stats);
  EXPECT_FALSE(growths.empty());
  for (const BeamSearch::Growth& g : growths) EXPECT_GT(g.candidate.moved, 0);
}

TEST_F(BeamSearchTest, ATreeWithoutPredecessorsEndsUntilItIsAimedAgain) {
  BeamSearch search = aimed();
  const SolveBatch none = [](std::span<const ReverseJob> jobs) {
    return std::vector<ReverseResult>(jobs.size(), {SolveStatus::kPruned, 0});
  };
  EXPECT_TRUE(search.grow(none, replay, stats).empty());
  EXPECT_TRUE(search.beam().empty());
  EXPECT_EQ(search.best(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(search.grow(solve, replay, stats).empty());
  search.aim({task.start}, config.breadth, replay, stats);
  EXPECT_FALSE(search.grow(solve, replay, stats).empty());
}

TEST_F(BeamSearchTest, AimTakesTheNearestOfAllNodesWhateverTheRanking) {
  config.random_share = 0.0;
  config.per_layout = 1000;
  Poses elsewhere = task.start;
  for (std::size_t k = 0; k < elsewhere.size(); ++k) elsewhere[k].y += 3.0;
  for (const Ranking ranking : kAllRankings)
    for (const Poses& target : {task.start, elsewhere}) {
      config.ranking = ranking;
      BeamSearch search = aimed();
      for (int layer = 0; layer < 4; ++layer) search.grow(solve, replay, stats);
      search.aim({target}, config.breadth, replay, stats);
      std::vector<double> nearest = distances(search, everything(search), target);
      nearest.resize(6);
      EXPECT_EQ(distances(search, search.beam(), target), nearest);
      EXPECT_EQ(search.best(), nearest[0]);
    }
}

TEST_F(BeamSearchTest, BestIsTheLeastDistanceOfTheBeamWhateverTheRanking) {
  for (const Ranking ranking : kAllRankings) {
    config.ranking = ranking;
    BeamSearch search = aimed();
    EXPECT_EQ(search.best(), distances(search, search.beam(), task.start)[0]);
    for (int layer = 0; layer < 4; ++layer) {
      search.grow(solve, replay, stats);
      EXPECT_EQ(search.best(), distances(search, search.beam(), task.start)[0]);
    }
  }
}

TEST_F(BeamSearchTest, NodesAreAFunctionOfTheSeed) {
  const auto nodes = [&](std::uint64_t seed) {
    BeamSearch search = aimed(seed);
    for (int layer = 0; layer < 3; ++layer) search.grow(solve, replay, stats);
    std::vector<Poses> out;
    for (const Node& n : search.nodes()) out.push_back(n.poses);
    return out;
  };
  EXPECT_EQ(nodes(1), nodes(1));
  EXPECT_NE(nodes(1), nodes(2));
}

}  // namespace
}  // namespace rtg
