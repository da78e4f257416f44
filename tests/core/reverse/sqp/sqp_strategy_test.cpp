#include "core/reverse/sqp/sqp_strategy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rtg::reverse {
namespace {

using Order = SqpStrategy::Order;

constexpr SqpStrategy::Figures kFar{1.0, 1.0, 1.0}, kNear{1.0, 1e-3, 1e-2}, kSolved{1.0, 0.0, 0.0};

/// Takes `count` steps at an iterate far from a solution.
void step(SqpStrategy& strategy, int count) {
  for (int k = 0; k < count; ++k) ASSERT_EQ(strategy.judge(kFar), Order::kGoOn) << k;
}

ReverseConfig without_softening() {
  ReverseConfig config;
  config.softenings = 0;
  return config;
}

/// An attempt that ended so, without a phase before.
void end_attempt(SqpStrategy& strategy, bool converged) {
  if (converged) {
    ASSERT_EQ(strategy.judge(kSolved), Order::kEndAttempt);
    ASSERT_EQ(strategy.status(), SolveStatus::kConverged);
    return;
  }
  Order order = Order::kGoOn;
  for (int k = 0; k < 100 && order == Order::kGoOn; ++k) order = strategy.reject_line_search();
  ASSERT_EQ(order, Order::kEndAttempt);
  ASSERT_EQ(strategy.status(), SolveStatus::kLineSearchFailed);
}

TEST(SqpStrategySoftening, AlternatesWithTheWholeSpringAsOftenAsAsked) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  EXPECT_EQ(strategy.terminal_weight(), config.terminal_weight);
  for (int k = 0; k < config.softenings; ++k) {
    EXPECT_EQ(strategy.judge(kNear), Order::kBeginPhase);
    EXPECT_LT(strategy.terminal_weight(), 0.5 * config.terminal_weight);
    EXPECT_EQ(strategy.judge(kSolved), Order::kBeginPhase);  // no solution with a soft spring
    EXPECT_EQ(strategy.terminal_weight(), config.terminal_weight);
  }
  EXPECT_EQ(strategy.judge(kNear), Order::kGoOn);
  EXPECT_EQ(strategy.iterations(), 1);  // phases that begin cost none
  EXPECT_EQ(strategy.judge(kSolved), Order::kEndAttempt);
  EXPECT_EQ(strategy.status(), SolveStatus::kConverged);
}

TEST(SqpStrategySoftening, APhaseEndsAfterAFewIterations) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  ASSERT_EQ(strategy.judge(kNear), Order::kBeginPhase);
  for (const int length : {6, 4, 6}) {
    step(strategy, length);
    EXPECT_EQ(strategy.judge(kFar), Order::kBeginPhase) << length;
  }
  EXPECT_EQ(strategy.terminal_weight(), config.terminal_weight);
  step(strategy, 50);  // the last has no end
}

TEST(SqpStrategySoftening, IsNotTriedOnAnIterateThatStaysFarForTwelveIterations) {
  const ReverseConfig config;
  SqpStrategy late(config);
  step(late, 13);
  EXPECT_EQ(late.judge(kNear), Order::kGoOn);
  EXPECT_EQ(late.terminal_weight(), config.terminal_weight);
  EXPECT_EQ(late.judge(kSolved), Order::kEndAttempt);
  SqpStrategy early(config);
  step(early, 12);
  EXPECT_EQ(early.judge(kNear), Order::kBeginPhase);
}

TEST(SqpStrategySoftening, IsNotTriedWhereTheFinalStateIsFixed) {
  ReverseConfig config;
  config.terminal_weight = 0.0;
  SqpStrategy strategy(config);
  EXPECT_EQ(strategy.judge(kNear), Order::kGoOn);
  EXPECT_EQ(strategy.terminal_weight(), 0.0);
}

TEST(SqpStrategySoftening, LooseTolerancesAreNearEnough) {
  ReverseConfig config;
  config.feasibility_tol = config.stationarity_tol = 0.5;
  SqpStrategy strategy(config);
  EXPECT_EQ(strategy.judge({1.0, 0.4, 0.4}), Order::kBeginPhase);
}

TEST(SqpStrategySoftening, APhaseThatFailsGivesWayToTheNext) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  ASSERT_EQ(strategy.judge(kNear), Order::kBeginPhase);
  Order order = Order::kGoOn;
  while (order == Order::kGoOn) order = strategy.reject_line_search();
  EXPECT_EQ(order, Order::kBeginPhase);
  EXPECT_EQ(strategy.terminal_weight(), config.terminal_weight);
  EXPECT_EQ(strategy.proximal(), config.proximal_start);
}

TEST(SqpStrategy, EndsWhereAFigureIsNotFinite) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const SqpStrategy::Figures& at :
       {SqpStrategy::Figures{nan, 0.0, 0.0}, {0.0, INFINITY, 0.0}, {0.0, 0.0, nan}}) {
    const ReverseConfig config;
    SqpStrategy strategy(config);
    EXPECT_EQ(strategy.judge(at), Order::kEndAttempt);
    EXPECT_EQ(strategy.status(), SolveStatus::kNonFinite);
  }
}

TEST(SqpStrategy, ConvergesOnlyWithinBothTolerances) {
  const ReverseConfig config = without_softening();
  SqpStrategy strategy(config);
  EXPECT_EQ(strategy.judge({0.0, 1.01 * config.feasibility_tol, 0.0}), Order::kGoOn);
  EXPECT_EQ(strategy.judge({0.0, 0.0, 1.01 * config.stationarity_tol}), Order::kGoOn);
  EXPECT_EQ(strategy.judge({0.0, 0.99 * config.feasibility_tol, 0.99 * config.stationarity_tol}),
            Order::kEndAttempt);
}

TEST(SqpStrategy, EndsAfterItsIterationsAndTriesNoMore) {
  ReverseConfig config = without_softening();
  config.max_iterations = 5;
  SqpStrategy strategy(config);
  step(strategy, 5);
  EXPECT_EQ(strategy.judge(kFar), Order::kEndAttempt);
  EXPECT_EQ(strategy.status(), SolveStatus::kIterationLimit);
  EXPECT_EQ(strategy.iterations(), 5);
  EXPECT_FALSE(strategy.try_again(strategy.status()));
}

TEST(SqpStrategy, ATurnToTheObjectivesHessianIsTheSameIteration) {
  const ReverseConfig config = without_softening();
  SqpStrategy strategy(config);
  step(strategy, 1);
  EXPECT_EQ(strategy.reject_ascent(), Order::kGoOn);
  EXPECT_FALSE(strategy.uses_lagrangian());
  EXPECT_EQ(strategy.proximal(), config.proximal_start);
  step(strategy, 1);
  EXPECT_EQ(strategy.iterations(), 1);
  EXPECT_EQ(strategy.reject_ascent(), Order::kGoOn);  // not convex even so
  EXPECT_TRUE(strategy.uses_lagrangian());
  EXPECT_EQ(strategy.proximal(), 4.0 * config.proximal_start);
}

TEST(SqpStrategy, EndsWhereNoRegularisationHelps) {
  const ReverseConfig config = without_softening();
  SqpStrategy ascending(config), stuck(config);
  Order order = Order::kGoOn;
  for (int k = 0; k < 100 && order == Order::kGoOn; ++k) order = ascending.reject_ascent();
  EXPECT_EQ(order, Order::kEndAttempt);
  EXPECT_EQ(ascending.status(), SolveStatus::kSingular);
  EXPECT_GT(ascending.proximal(), 1e6);
  end_attempt(stuck, false);
}

TEST(SqpStrategy, ProximalTermFollowsTheStepLength) {
  const ReverseConfig config = without_softening();
  double violation = 1.0;
  const auto after = [&](SqpStrategy& strategy, double alpha) {
    const double next = 0.5 * violation;
    EXPECT_TRUE(strategy.accept({violation, 0.0}, {next, 0.0}, alpha));
    violation = next;
    return strategy.proximal();
  };
  SqpStrategy strategy(config);
  EXPECT_DOUBLE_EQ(after(strategy, 1.0), 0.1 * config.proximal_start);
  EXPECT_DOUBLE_EQ(after(strategy, 0.5), 0.1 * config.proximal_start);
  EXPECT_DOUBLE_EQ(after(strategy, 0.125), 0.4 * config.proximal_start);
  for (int k = 0; k < 20; ++k) after(strategy, 1.0);
  EXPECT_DOUBLE_EQ(strategy.proximal(), 1e-8);
}

TEST(SqpStrategy, AStepThatIsTakenBringsTheHessianOfTheLagrangianBack) {
  const ReverseConfig config = without_softening();
  SqpStrategy strategy(config);
  strategy.reject_ascent();
  ASSERT_FALSE(strategy.uses_lagrangian());
  EXPECT_TRUE(strategy.accept({1.0, 0.0}, {0.5, 0.0}, 1.0));
  EXPECT_TRUE(strategy.uses_lagrangian());
}

TEST(SqpStrategy, ATrialPointMustImproveAndBeNewToTheFilter) {
  const ReverseConfig config = without_softening();
  SqpStrategy strategy(config);
  EXPECT_FALSE(strategy.accept({0.1, 1.0}, {0.1, 1.0}, 1.0));   // as now
  EXPECT_FALSE(strategy.accept({0.1, 1.0}, {0.35, 0.0}, 1.0));  // far from feasible
  EXPECT_FALSE(strategy.accept({0.1, 1.0}, {0.05, NAN}, 1.0));
  EXPECT_TRUE(strategy.accept({0.1, 1.0}, {0.25, 0.5}, 1.0));
  EXPECT_FALSE(strategy.accept({0.25, 0.5}, {0.1, 1.0}, 1.0));  // where it came from
  EXPECT_TRUE(strategy.accept({0.25, 0.5}, {0.05, 1.0}, 1.0));
  EXPECT_TRUE(strategy.accept({0.8, 0.0}, {0.7, 0.0}, 1.0));  // no farther than it was
}

TEST(SqpStrategy, APhaseBeginsWithAnEmptyFilter) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  ASSERT_TRUE(strategy.accept({0.1, 1.0}, {0.05, 1.0}, 1.0));
  ASSERT_FALSE(strategy.accept({0.2, 1.0}, {0.1, 1.0}, 1.0));
  ASSERT_EQ(strategy.judge(kNear), Order::kBeginPhase);
  EXPECT_TRUE(strategy.accept({0.2, 1.0}, {0.1, 1.0}, 1.0));
}

TEST(SqpStrategyAttempts, EndWithASolution) {
  const ReverseConfig config = without_softening();
  SqpStrategy strategy(config);
  end_attempt(strategy, true);
  EXPECT_TRUE(strategy.replaces_result(SolveStatus::kConverged));
  EXPECT_FALSE(strategy.try_again(SolveStatus::kConverged));
  EXPECT_EQ(strategy.attempts(), 1);
}

TEST(SqpStrategyAttempts, AreThreeAtMostEachWithALargerFirstProximalTerm) {
  const ReverseConfig config = without_softening();
  SqpStrategy strategy(config);
  for (const double scale : {1.0, 4.0, 16.0}) {
    EXPECT_EQ(strategy.proximal(), scale * config.proximal_start);
    end_attempt(strategy, false);
    EXPECT_TRUE(
        strategy.replaces_result(strategy.status()));  // a later failure replaces an earlier
    EXPECT_EQ(strategy.try_again(strategy.status()), scale < 16.0);
  }
  EXPECT_EQ(strategy.attempts(), 3);
}

TEST(SqpStrategyAttempts, OfSolutionsThatMissTheFinalStateTheFirstCounts) {
  const ReverseConfig config = without_softening();
  SqpStrategy strategy(config);
  end_attempt(strategy, true);
  EXPECT_TRUE(strategy.replaces_result(SolveStatus::kInfeasible));
  ASSERT_TRUE(strategy.try_again(SolveStatus::kInfeasible));
  EXPECT_FALSE(strategy.replaces_result(SolveStatus::kInfeasible));
  EXPECT_FALSE(strategy.replaces_result(SolveStatus::kLineSearchFailed));
  EXPECT_TRUE(strategy.replaces_result(SolveStatus::kConverged));
  EXPECT_FALSE(strategy.try_again(SolveStatus::kInfeasible));
}

TEST(SqpStrategyAttempts, AFailureBetweenMissesDoesNotHideTheFirst) {
  const ReverseConfig config = without_softening();
  SqpStrategy strategy(config);
  ASSERT_TRUE(strategy.try_again(SolveStatus::kInfeasible));
  ASSERT_TRUE(strategy.try_again(SolveStatus::kLineSearchFailed));
  EXPECT_FALSE(strategy.replaces_result(SolveStatus::kInfeasible));
}

TEST(SqpStrategyAttempts, WhereASofteningFailedTheNextBeginsWithTheSameProximalTerm) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  ASSERT_EQ(strategy.judge(kNear), Order::kBeginPhase);
  ASSERT_TRUE(strategy.try_again(SolveStatus::kLineSearchFailed));
  EXPECT_EQ(strategy.proximal(), config.proximal_start);
  EXPECT_EQ(strategy.judge(kNear), Order::kGoOn);  // the first attempt alone softens
  ASSERT_TRUE(strategy.try_again(SolveStatus::kLineSearchFailed));
  EXPECT_EQ(strategy.proximal(), 4.0 * config.proximal_start);
}

TEST(SqpStrategyAttempts, AfterAMissTheFirstProximalTermGrowsInAnyCase) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  ASSERT_EQ(strategy.judge(kNear), Order::kBeginPhase);
  ASSERT_TRUE(strategy.try_again(SolveStatus::kInfeasible));
  EXPECT_EQ(strategy.proximal(), 4.0 * config.proximal_start);
}

}  // namespace
}  // namespace rtg::reverse
