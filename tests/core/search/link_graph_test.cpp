#include "core/search/link_graph.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "core/math/rng.hpp"
#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;
using testing::robot_at;

Transition link(double from, double to, bool success = false) {
  return {robot_at(from), 0, robot_at(to), success, Source::kStepReplay};
}

double reachable(const std::vector<Transition>& all) {
  LinkGraph graph(gathering().scene);
  for (const Transition& t : all) graph.add(t);
  return graph.reachable_share();
}

TEST(ReachableShare, OfNothingIsZero) { EXPECT_EQ(reachable({}), 0.0); }

TEST(ReachableShare, FollowsAChainToItsSuccess) {
  EXPECT_EQ(reachable({link(0, 1), link(1, 2), link(2, 3, true)}), 1.0);
  EXPECT_EQ(reachable({link(2, 3, true), link(0, 1), link(1, 2)}), 1.0);
  EXPECT_EQ(reachable({link(0, 1), link(1, 2), link(2, 3)}), 0.0);
}

TEST(ReachableShare, LeavesDeadEndsAndIslandsOut) {
  const std::vector<Transition> graph{link(0, 1), link(1, 2, true), link(1, 5), link(7, 6),
                                      link(2, 4)};
  EXPECT_EQ(reachable(graph), 2.0 / 5.0);
}

TEST(ReachableShare, CyclesDoNotCountAsSuccess) {
  EXPECT_EQ(reachable({link(0, 1), link(1, 0), link(4, 5, true)}), 1.0 / 3.0);
}

TEST(ReachableShare, ParallelLinksAllCount) {
  EXPECT_EQ(reachable({link(0, 2), link(1, 2), link(-3, 2), link(2, 3, true), link(2, 4, true)}),
            1.0);
}

TEST(ReachableShare, NeighboursLinkAcrossTheLinesBetweenSquares) {
  for (const double line : {0.0, 0.25, -0.75, 1.0, 0.13}) {
    EXPECT_EQ(reachable({link(5, line - 0.03), link(line + 0.03, 7, true)}), 1.0) << line;
    EXPECT_EQ(reachable({link(5, line - 0.13), link(line + 0.13, 7, true)}), 0.5) << line;
  }
}

TEST(ReachableShare, ALongPlanOfSmallMissesHolds) {
  std::vector<Transition> graph;
  for (int k = 0; k < 40; ++k) {
    graph.push_back(link(0.1 * k, 0.1 * (k + 1), k == 39));
    for (std::size_t body = 1; body < 4; ++body) {
      graph.back().next[body].x += 0.2;
      graph.back().next[body].theta -= 0.2;
    }
  }
  EXPECT_EQ(reachable(graph), 1.0);
}

TEST(ReachableShare, EveryBodyMustBeWhereTheNextLinkBegins) {
  std::vector<Transition> graph{link(0, 1), link(1, 2, true)};
  graph[1].poses[3].x += 0.3;
  EXPECT_EQ(reachable(graph), 0.5);
  graph[1].poses[3].x -= 0.3;
  graph[1].poses[3].theta += std::numbers::pi / 2.0;  // a square looks the same
  EXPECT_EQ(reachable(graph), 1.0);
  graph[1].poses[3].theta += 0.7;
  EXPECT_EQ(reachable(graph), 0.5);
}

/// Share of the transitions that lead to success, by going over all pairs until nothing changes.
double naive_reachable(const std::vector<std::array<int, 2>>& links,
                       const std::vector<bool>& wins) {
  std::vector<bool> reached = wins;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < links.size(); ++a)
      for (std::size_t b = 0; b < links.size(); ++b)
        if (!reached[a] && reached[b] && links[a][1] == links[b][0]) reached[a] = changed = true;
  }
  double count = 0.0;
  for (const bool r : reached) count += r;
  return count / static_cast<double>(links.size());
}

TEST(ReachableShare, MatchesAFixedPointOnRandomGraphs) {
  Rng rng(31);
  double sum = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<std::array<int, 2>> links;
    std::vector<bool> wins;
    std::vector<Transition> graph;
    for (int k = 0; k < 60; ++k) {
      links.push_back({rng.below(50), rng.below(50)});
      wins.push_back(rng.below(12) == 0);
      graph.push_back(link(links.back()[0], links.back()[1], wins.back()));
    }
    ASSERT_DOUBLE_EQ(reachable(graph), naive_reachable(links, wins));
    sum += reachable(graph) / 50.0;
  }
  EXPECT_GT(sum, 0.1);  // neither nothing nor all of it, or the comparison says little
  EXPECT_LT(sum, 0.9);
}

}  // namespace
}  // namespace rtg
