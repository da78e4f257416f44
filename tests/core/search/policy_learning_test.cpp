#include "core/search/policy_learning.hpp"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;
using testing::robot_at;

TreePolicy::Choice choice(const TreePolicy& policy, const Poses& state) {
  return policy.choose(std::vector<TreePolicy::Query>{{state, {}}}).front();
}

/// Depth that the policy has for a state of its own.
double depth_at(const TreePolicy& policy, double x) { return choice(policy, robot_at(x)).score; }

int action_at(const TreePolicy& policy, double x) { return choice(policy, robot_at(x)).action; }

/// A step from robot at x to node `parent`.
BeamSearch::Growth step(double x, int action, int parent, int depth) {
  BeamSearch::Growth out;
  out.candidate = {parent, action, robot_at(x), robot_at(x - 1.0)};
  out.depth = depth;
  return out;
}

/// A plan: the goal at 0, then nodes at 1, 2, 3 that lead to it by actions 11, 12, 13.
const std::vector<Node> kPlan{{robot_at(0.0), -1, -1, 0},
                              {robot_at(1.0), 0, 11, 1},
                              {robot_at(2.0), 1, 12, 2},
                              {robot_at(3.0), 2, 13, 3}};

TEST(LearnStep, TakesUpThePlanBehindIt) {
  TreePolicy policy(gathering());
  learn_step(policy, step(4.0, 14, 3, 4), kPlan);
  EXPECT_EQ(policy.size(), 4);
  for (int k = 1; k <= 4; ++k) {
    EXPECT_EQ(action_at(policy, k), 10 + k);
    EXPECT_EQ(depth_at(policy, k), k);
  }
}

TEST(LearnStep, KeepsWhatIsKnownOfThePlan) {
  TreePolicy policy(gathering());
  learn_step(policy, step(3.0, 13, 2, 3), kPlan);
  policy.raise(0, 5.0);
  learn_step(policy, step(4.0, 14, 3, 4), kPlan);
  learn_step(policy, step(4.0, 14, 3, 4), kPlan);
  EXPECT_EQ(policy.size(), 4);
  EXPECT_EQ(depth_at(policy, 2.0), 7.0);
  EXPECT_EQ(depth_at(policy, 4.0), 4.0);
}

TEST(LearnStep, NeedsNothingBehindAStepIntoTheGoal) {
  TreePolicy policy(gathering());
  learn_step(policy, step(4.0, 14, 3, 1), kPlan);
  EXPECT_EQ(policy.size(), 1);
  EXPECT_EQ(depth_at(policy, 4.0), 1.0);
}

TEST(LearnStep, ThePlanEndsWithANodeThatReachesTheGoalOnItsOwn) {
  std::vector<Node> nodes = kPlan;
  nodes[2].depth = 1;
  nodes[3].depth = 2;
  TreePolicy policy(gathering());
  learn_step(policy, step(4.0, 14, 3, 3), nodes);
  EXPECT_EQ(policy.size(), 3);
  for (int k = 2; k <= 4; ++k) EXPECT_EQ(depth_at(policy, k), k - 1.0);
}

TEST(LearnEpisode, CountsTheActionsToItsEnd) {
  TreePolicy policy(gathering());
  std::vector<Transition> steps{{robot_at(2.0), 12, robot_at(1.0), false},
                                {robot_at(1.0), 11, robot_at(0.0), true}};
  learn_episode(policy, steps);
  EXPECT_EQ(policy.size(), 2);
  EXPECT_EQ(depth_at(policy, 2.0), 2.0);
  EXPECT_EQ(depth_at(policy, 1.0), 1.0);
  EXPECT_EQ(action_at(policy, 2.0), 12);
}

TEST(LearnEpisode, LearnsNothingFromOneThatFails) {
  TreePolicy policy(gathering());
  learn_episode(policy, {});
  learn_episode(policy, std::vector<Transition>{{robot_at(2.0), 12, robot_at(1.0), false}});
  EXPECT_EQ(policy.size(), 0);
}

/// A policy of depth 3 at x = 0, and behind it what a round has found: depth 1 at x = 3. Ratings
/// are a table of the price that the round's entry bears; -1 stands for the policy without it.
struct Climb : ::testing::Test {
  /// 0.5 where nothing is said.
  using Ratings = std::map<double, double>;

  TreePolicy policy{gathering()};
  std::vector<double> tried, tried_anew;

  /// Price in the policy that is left.
  double climb(const Ratings& ratings, const Ratings& anew = {}) {
    policy.forget(0);
    policy.add(robot_at(0.0), 7, 3.0);
    policy.add(robot_at(3.0), 8, 1.0);
    tried.clear();
    tried_anew.clear();
    const auto rate = [&](const TreePolicy& p) { return rated(ratings, tried, price(p)); };
    const auto rate_anew = [&](const TreePolicy& p) { return rated(anew, tried_anew, price(p)); };
    rtg::climb(policy, 1, ratings.contains(-1.0) ? ratings.at(-1.0) : 0.5, rate, rate_anew);
    EXPECT_EQ(depth_at(policy, 0.0), 3.0) << "what was known keeps its depth";
    return price(policy);
  }

  static double rated(const Ratings& ratings, std::vector<double>& tried, double price) {
    tried.push_back(price);
    return ratings.contains(price) ? ratings.at(price) : 0.5;
  }

  static double price(const TreePolicy& policy) {
    return policy.size() == 1 ? -1.0 : depth_at(policy, 3.0) - 1.0;
  }
};

TEST_F(Climb, TakesThePriceThatServesBest) {
  EXPECT_EQ(climb({{0.0, 0.1}, {8.0, 0.9}, {32.0, 0.7}, {-1.0, 0.8}}), 8.0);
  EXPECT_EQ(climb({{32.0, 0.6}}), 32.0);
  EXPECT_EQ(climb({{0.0, 0.1}, {-1.0, 0.2}}), 8.0) << "of equals the lowest";
}

TEST_F(Climb, StaysWhereItWasUnlessItGetsBetter) {
  EXPECT_EQ(climb({{-1.0, 0.6}, {0.0, 0.4}}), -1.0);
  EXPECT_EQ(climb({}), -1.0);
  EXPECT_TRUE(tried_anew.empty());
}

TEST_F(Climb, AsksAnewWhetherItGetsBetter) {
  const Ratings gain{{8.0, 0.75}};  // instead of 0.5
  EXPECT_EQ(climb(gain, {{8.0, 0.375}}), 8.0);
  EXPECT_EQ(tried_anew, (std::vector{8.0, -1.0}));
  EXPECT_EQ(climb(gain, {{8.0, 0.25}}), -1.0);
  EXPECT_EQ(climb(gain, {{-1.0, 0.75}}), -1.0);
}

TEST_F(Climb, TakesUpAllWhereNothingIsSolved) {
  EXPECT_EQ(climb({{-1.0, 0.0}, {0.0, 0.0}, {8.0, 0.0}, {32.0, 0.0}}), 0.0);
  EXPECT_EQ(climb({{-1.0, 0.0}, {0.0, 0.0}, {8.0, 0.25}}, {{32.0, 0.0}}), 32.0);
  EXPECT_TRUE(tried_anew.empty());
}

TEST_F(Climb, LooksNoFurtherThanPerfection) {
  EXPECT_EQ(climb({{8.0, 1.0}, {-1.0, 0.75}}), 8.0);
  EXPECT_EQ(tried, (std::vector{0.0, 8.0}));
}

TEST_F(Climb, AsksNothingWhereAllIsSolved) {
  EXPECT_EQ(climb({{-1.0, 1.0}}), -1.0);
  EXPECT_TRUE(tried.empty());
}

TEST_F(Climb, AsksNothingWhereARoundHasFoundNothing) {
  policy.add(robot_at(0.0), 7, 3.0);
  const auto asked = [](const TreePolicy&) -> double { throw std::logic_error("asked"); };
  rtg::climb(policy, 1, 0.5, asked, asked);
  EXPECT_EQ(policy.size(), 1);
}

}  // namespace
}  // namespace rtg
