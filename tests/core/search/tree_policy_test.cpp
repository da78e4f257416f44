#include "core/search/tree_policy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/math/rng.hpp"
#include "core/reverse/reverse_job.hpp"
#include "tests/support/brute_policy.hpp"

namespace rtg {
namespace {

using testing::Entry;
using testing::gathering;
using testing::Policy;
using testing::random_entry;
using testing::random_policy;

TEST(TreePolicy, ChoosesAsBruteForceDoes) {
  const Policy tree = random_policy(1300);
  Rng rng(12);
  std::vector<TreePolicy::Query> queries;
  for (int q = 0; q < 200; ++q) {
    queries.push_back({random_entry(rng).state, {}});
    for (int k = 0; k < q; ++k) queries.back().used.push_back(rng.below(tree.policy.size()));
    // So that the best ones are used, too.
    for (int k = 0; k < q % 3; ++k) queries.back().used.push_back(tree.best(queries.back()));
  }
  const std::vector<TreePolicy::Choice> choices = tree.policy.choose(queries);
  ASSERT_EQ(choices.size(), queries.size());
  for (std::size_t q = 0; q < queries.size(); ++q) {
    const int best = tree.best(queries[q]);
    ASSERT_EQ(choices[q].entry, best);
    const Entry& entry = tree.entries[static_cast<std::size_t>(best)];
    ASSERT_EQ(choices[q].action, entry.action);
    // Single precision of a score of up to 200.
    ASSERT_NEAR(choices[q].score, tree.score(best, queries[q].state), 1e-4);
    ASSERT_NEAR(choices[q].distance, tree.distance(best, queries[q].state), 1e-5);
  }
}

TEST(TreePolicy, AlternativesAreTheBestOfEachActionBestFirst) {
  const Policy tree = random_policy(400);
  Rng rng(13);
  for (int q = 0; q < 30; ++q) {
    TreePolicy::Query query{random_entry(rng).state, {}};
    query.used.push_back(tree.best(query));
    std::map<int, double> least;  // score by action
    for (int k = 0; k < tree.policy.size(); ++k) {
      if (k == query.used[0]) continue;
      const int action = tree.entries[static_cast<std::size_t>(k)].action;
      const double score = tree.score(k, query.state);
      least[action] = std::min(least.try_emplace(action, score).first->second, score);
    }
    std::vector<double> wanted;
    for (const auto& [action, score] : least) wanted.push_back(score);
    std::ranges::sort(wanted);
    const std::vector<TreePolicy::Choice> found = tree.policy.alternatives(query, 5);
    ASSERT_EQ(found.size(), 5U);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k].score, wanted[k], 1e-4);
      EXPECT_NEAR(least.at(found[k].action), wanted[k], 1e-4);
    }
    EXPECT_EQ(tree.policy.alternatives(query, 100).size(), least.size());
  }
}

TEST(TreePolicy, ChoosesAsBruteForceDoesAtTheEdgesOfCells) {
  Rng rng(16);
  const Entry one = random_entry(rng);
  const auto at = [&](double x, double y) {
    Entry entry = one;
    entry.state[0] = {x, y, 0.0};
    entry.depth = 1.0 + rng.below(3);
    return entry;
  };
  std::vector<Entry> entries;
  for (int x = -8; x <= 8; ++x)
    for (int y = -8; y <= 8; ++y)
      for (const double off : {-0.01, 0.0, 0.01, 0.25})
        entries.push_back(at(0.5 * x + off, 0.5 * y - off));
  const Policy tree(std::move(entries));
  for (int x = -9; x <= 9; ++x)
    for (int y = -9; y <= 9; ++y) {
      const TreePolicy::Query query{at(0.5 * x + 0.02, 0.5 * y + 0.02).state, {}};
      ASSERT_EQ(tree.choose(query).entry, tree.best(query));
    }
}

TEST(TreePolicy, TiesGoToTheOldestEntry) {
  Rng rng(13);
  const Entry here = random_entry(rng);
  std::vector<Entry> entries;
  for (int k = 0; k < 1500; ++k) {
    entries.push_back(here);
    entries.back().state[0].theta = k;  // all the same to the metric
    entries.back().action = k % 48;
    if (k < 40) entries.back().depth = here.depth + 1.0;
  }
  const Policy tree(std::move(entries));
  TreePolicy::Query query{here.state, {}};
  for (int k = 40; k < 1500; ++k) {
    const TreePolicy::Choice choice = tree.choose(query);
    ASSERT_EQ(choice.entry, k);
    ASSERT_EQ(choice.action, k % 48);
    query.used.push_back(k);
  }
  EXPECT_EQ(tree.choose(query).entry, 0);
}

TEST(TreePolicy, TiesGoToTheOldestEntryOfAnyCell) {
  Entry left{{{-0.25, 0, 0}, {6, 6, 0}, {-6, 6, 0}, {-6, -6, 0}}, 1, 4.0}, right = left;
  right.state[0].x = 0.25;
  Poses between = left.state;
  between[0].x = 0.0;  // on the edge of the cell to the right: that one comes first
  EXPECT_EQ(Policy({left, right}).choose({between, {}}).action, 1);
  right.action = 2;
  EXPECT_EQ(Policy({left, right}).choose({between, {}}).action, 1);
  EXPECT_EQ(Policy({right, left}).choose({between, {}}).action, 2);
}

TEST(TreePolicy, PrefersAPushThatMeetsTheSameToANearerOneThatMeetsNothing) {
  const Poses state{{0, 0, 0}, {2, 1.2, 0}, {-6, 6, 0}, {-6, -6, 0}};  // along x it grazes the box
  Poses hit = state, miss = state;
  hit[1].x += 0.12;
  miss[1].y += 0.1;
  const Policy tree({{miss, 0, 5.0}, {hit, 0, 5.0}});
  EXPECT_GT(tree.metric.distance(hit, state), tree.metric.distance(miss, state));
  EXPECT_EQ(tree.choose({state, {}}).entry, 1);
}

TEST(TreePolicy, HasNoChoiceWithoutAnEntryLeft) {
  EXPECT_EQ(Policy({}).choose({gathering().start, {}}).entry, -1);
  Rng rng(14);
  const Policy tree({random_entry(rng), random_entry(rng)});
  EXPECT_EQ(tree.choose({gathering().start, {1, 0}}).entry, -1);
  EXPECT_NE(tree.choose({gathering().start, {1}}).entry, -1);
}

TEST(TreePolicy, OneMetreOfTheRobotCountsAsSixteenActions) {
  Entry here{gathering().start, 1, 4.0}, beside = here;
  beside.state[0].x += 0.125;  // 2 actions
  beside.action = 2;
  beside.depth = 1.9;
  EXPECT_EQ(Policy({here, beside}).choose({here.state, {}}).action, 2);
  beside.depth = 2.1;
  EXPECT_EQ(Policy({here, beside}).choose({here.state, {}}).action, 1);
}

TEST(TreePolicy, HasAStateAndActionOnce) {
  Policy tree = random_policy(3);
  const Entry& known = tree.entries[1];
  EXPECT_FALSE(tree.policy.add(known.state, known.action, 1.0));
  EXPECT_EQ(tree.policy.size(), 3);
  EXPECT_EQ(tree.choose({known.state, {}}).score, known.depth);
  EXPECT_TRUE(tree.policy.add(known.state, (known.action + 1) % 48, 100.0));
  EXPECT_EQ(tree.policy.size(), 4);
}

TEST(TreePolicy, RaisesTheDepthOfItsLastEntries) {
  Policy tree = random_policy(3);
  tree.policy.raise(1, 2.5);
  for (int k = 0; k < 3; ++k) {
    const Entry& e = tree.entries[static_cast<std::size_t>(k)];
    const TreePolicy::Choice choice = tree.choose({e.state, {}});
    EXPECT_EQ(choice.entry, k);
    EXPECT_EQ(choice.score, e.depth + (k == 0 ? 0.0 : 2.5));
  }
}

TEST(TreePolicy, APriceCanBeTakenBack) {
  Policy tree = random_policy(400);
  tree.policy.raise(100, 100.0);
  tree.policy.raise(100, -100.0);
  Rng rng(17);
  for (int q = 0; q < 50; ++q) {
    const TreePolicy::Query query{random_entry(rng).state, {}};
    EXPECT_EQ(tree.choose(query).entry, tree.best(query));
  }
}

TEST(TreePolicy, ForgetsItsLastEntriesAndLearnsThemAgain) {
  Policy tree = random_policy(400);
  const auto entry = [&](int k) -> const Entry& {
    return tree.entries[static_cast<std::size_t>(k)];
  };
  tree.policy.raise(300, 100.0);
  tree.policy.forget(150);
  EXPECT_EQ(tree.policy.size(), 150);
  for (int k = 0; k < 400; ++k) {
    const TreePolicy::Query query{entry(k).state, {}};
    EXPECT_EQ(tree.choose(query).entry, tree.best(query));
  }
  EXPECT_FALSE(tree.policy.add(entry(149).state, entry(149).action, entry(149).depth));
  for (int k = 150; k < 400; ++k)
    EXPECT_TRUE(tree.policy.add(entry(k).state, entry(k).action, entry(k).depth));
  for (int k = 0; k < 400; ++k) {
    EXPECT_EQ(tree.choose({entry(k).state, {}}).entry, k);
    EXPECT_EQ(tree.choose({entry(k).state, {}}).score, entry(k).depth);
  }
}

TEST(TreePolicy, RetainsWhatItIsToldAndForgetsTheRest) {
  Rng rng(8);
  std::vector<Entry> entries, kept;
  for (int k = 0; k < 300; ++k) entries.push_back(random_entry(rng));
  Policy all(entries);
  all.policy.raise(200, 5.0);
  std::unordered_set<std::uint64_t> keys;
  for (std::size_t k = 0; k < entries.size(); k += 3) {
    kept.push_back(entries[k]);
    kept.back().depth += k >= 200 ? 5.0 : 0.0;
    keys.insert(key_of(entries[k].state, entries[k].action));
    EXPECT_EQ(all.policy.key(static_cast<int>(k)), key_of(entries[k].state, entries[k].action));
  }
  all.policy.retain(keys);
  const Policy few(kept);
  EXPECT_EQ(all.policy.size(), 100);
  for (int k = 0; k < 100; ++k) {
    const std::vector<TreePolicy::Query> query{{random_entry(rng).state, {}}};
    const TreePolicy::Choice left = all.policy.choose(query)[0],
                             fresh = few.policy.choose(query)[0];
    EXPECT_EQ(left.entry, fresh.entry);
    EXPECT_EQ(left.score, fresh.score);
  }
  EXPECT_TRUE(all.policy.add(entries[1].state, entries[1].action, 1.0)) << "forgotten";
  EXPECT_FALSE(all.policy.add(entries[0].state, entries[0].action, 1.0)) << "retained";
}

TEST(TreePolicy, KnowsStatesThatLookTheSame) {
  const Policy tree = random_policy(100);
  Poses turned = tree.entries[50].state;
  turned[0].theta += 1.0471975511965977;  // a sixth of a hexagon
  turned[2].theta -= 1.5707963267948966;  // a quarter of a square
  const TreePolicy::Choice choice = tree.choose({turned, {}});
  EXPECT_EQ(choice.entry, 50);
  EXPECT_NEAR(choice.score, tree.entries[50].depth, 1e-4);
}

}  // namespace
}  // namespace rtg
