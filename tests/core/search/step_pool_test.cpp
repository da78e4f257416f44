#include "core/search/step_pool.hpp"

#include <gtest/gtest.h>

#include "core/reverse/reverse_job.hpp"
#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::robot_at;

/// From robot at x to x - 1.
Transition step(int x) { return {robot_at(x), x, robot_at(x - 1), x == 1, Source::kStepReplay}; }

std::uint64_t key(int x) { return key_of(robot_at(x), x); }

/// A plan 3 -> 2 -> 1, and 12, a branch that joins it at 2.
StepPool plan() {
  StepPool pool;
  pool.add(step(1), std::nullopt);
  pool.add(step(2), 0);
  pool.add(step(3), 1);
  pool.add(step(12), 1);
  return pool;
}

std::vector<int> actions(const std::vector<Transition>& steps) {
  std::vector<int> out;
  for (const Transition& t : steps) out.push_back(t.action);
  return out;
}

TEST(StepPool, FindsStepsByStartAndAction) {
  const StepPool pool = plan();
  EXPECT_EQ(pool.find(key(3)), 2U);
  EXPECT_EQ(pool.find(key(4)), std::nullopt);
}

TEST(StepPool, KeepsTheFirstOfAStep) {
  StepPool pool = plan();
  pool.add(step(3), std::nullopt);
  EXPECT_EQ(pool.size(), 4U);
  EXPECT_EQ(actions(pool.take(2, 10)), (std::vector{3, 2, 1}));
}

TEST(StepPool, AKnownStepTakesUpAPlanToSuccessIfItHasNone) {
  StepPool pool = plan();
  pool.add(step(20), std::nullopt);
  pool.add(step(21), 4);
  pool.add(step(20), 5);  // leads nowhere, and would go in circles
  EXPECT_FALSE(pool.leads(5));
  pool.add(step(20), 1);
  EXPECT_TRUE(pool.leads(4));
  EXPECT_TRUE(pool.leads(5)) << "it goes on there";
  pool.add(step(20), 2);
  EXPECT_EQ(pool.size(), 6U);
  EXPECT_EQ(actions(pool.take(5, 10)), (std::vector{21, 20, 2, 1})) << "it has one already";
}

TEST(StepPool, TakesAStepWithItsPlanOnce) {
  StepPool pool = plan();
  EXPECT_EQ(actions(pool.take(1, 10)), (std::vector{2, 1}));
  EXPECT_EQ(actions(pool.take(3, 10)), (std::vector{12}));
  EXPECT_TRUE(pool.take(0, 10).empty());
  EXPECT_EQ(actions(pool.take(2, 10)), (std::vector{3}));
  EXPECT_EQ(pool.taken().size(), 4U);
}

TEST(StepPool, TakesAPlanThatWasFoundAfterItsFirstStepWasTaken) {
  StepPool pool = plan();
  pool.add(step(20), std::nullopt);
  pool.add(step(21), 4);
  EXPECT_EQ(actions(pool.take(4, 10)), (std::vector{20}));
  pool.add(step(20), 1);
  EXPECT_EQ(actions(pool.take(5, 10)), (std::vector{21, 2, 1}));
}

TEST(StepPool, KnowsWhichPlansEndInSuccess) {
  StepPool pool = plan();
  pool.add(step(20), std::nullopt);
  pool.add(step(21), 4);
  for (const StepPool::Index k : {0U, 1U, 2U, 3U}) EXPECT_TRUE(pool.leads(k));
  for (const StepPool::Index k : {4U, 5U}) EXPECT_FALSE(pool.leads(k));
}

TEST(StepPool, TakesNoMoreThanThereIsRoomFor) {
  StepPool pool = plan();
  EXPECT_EQ(actions(pool.take(2, 2)), (std::vector{3, 2}));
  EXPECT_FALSE(pool.taken().contains(key(1)));
  EXPECT_TRUE(pool.take(0, 0).empty());
  EXPECT_EQ(actions(pool.take(0, 1)), (std::vector{1}));
}

}  // namespace
}  // namespace rtg
