#include "core/reverse/sqp/sqp_strategy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rtg::reverse {
namespace {

constexpr SqpStrategy::Figures kFar{1.0, 1.0, 1.0};

/// Takes `count` steps at an iterate far from a solution.
void step(SqpStrategy& strategy, int count) {
  for (int k = 0; k < count; ++k) ASSERT_TRUE(strategy.goes_on(kFar)) << k;
}

TEST(SqpStrategy, EndsWhereAFigureIsNotFinite) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const SqpStrategy::Figures& at :
       {SqpStrategy::Figures{nan, 0.0, 0.0}, {0.0, INFINITY, 0.0}, {0.0, 0.0, nan}}) {
    const ReverseConfig config;
    SqpStrategy strategy(config);
    EXPECT_FALSE(strategy.goes_on(at));
    EXPECT_EQ(strategy.status(), SolveStatus::kNonFinite);
  }
}

TEST(SqpStrategy, ConvergesOnlyWithinBothTolerances) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  EXPECT_TRUE(strategy.goes_on({0.0, 1.01 * config.feasibility_tol, 0.0}));
  EXPECT_TRUE(strategy.goes_on({0.0, 0.0, 1.01 * config.stationarity_tol}));
  EXPECT_FALSE(
      strategy.goes_on({0.0, 0.99 * config.feasibility_tol, 0.99 * config.stationarity_tol}));
}

TEST(SqpStrategy, RestoresFeasibilityAfterItsIterationsAndEnds) {
  ReverseConfig config;
  config.max_iterations = 5;
  SqpStrategy strategy(config);
  step(strategy, 5);
  EXPECT_FALSE(strategy.wants_restoration());
  EXPECT_TRUE(strategy.goes_on(kFar));
  EXPECT_TRUE(strategy.wants_restoration());
  EXPECT_TRUE(strategy.take_restoration());
  EXPECT_FALSE(strategy.goes_on(kFar));
  EXPECT_EQ(strategy.status(), SolveStatus::kIterationLimit);
  EXPECT_EQ(strategy.iterations(), 5);
}

TEST(SqpStrategy, ATurnToTheObjectivesHessianIsTheSameIteration) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  step(strategy, 1);
  EXPECT_TRUE(strategy.reject_ascent());
  EXPECT_FALSE(strategy.uses_lagrangian());
  EXPECT_EQ(strategy.proximal(), config.proximal_start);
  step(strategy, 1);
  EXPECT_EQ(strategy.iterations(), 1);
  EXPECT_TRUE(strategy.reject_ascent());  // not convex even so
  EXPECT_TRUE(strategy.uses_lagrangian());
  EXPECT_EQ(strategy.proximal(), 4.0 * config.proximal_start);
}

TEST(SqpStrategy, EndsWhereNoRegularisationHelps) {
  const ReverseConfig config;
  SqpStrategy ascending(config), stuck(config);
  int tries = 0;
  while (tries < 100 && ascending.reject_ascent()) ++tries;
  EXPECT_LT(tries, 100);
  EXPECT_EQ(ascending.status(), SolveStatus::kSingular);
  EXPECT_GT(ascending.proximal(), 1e6);
  tries = 0;
  while (tries < 100 && stuck.reject_line_search()) ++tries;
  EXPECT_LT(tries, 100);
  EXPECT_EQ(stuck.status(), SolveStatus::kLineSearchFailed);
}

TEST(SqpStrategy, EmptiesTheFilterOnceBeforeItEnds) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  ASSERT_TRUE(strategy.accept({0.1, 1.0}, {0.05, 1.0}, 1.0));
  ASSERT_FALSE(strategy.accept({0.2, 1.0}, {0.1, 1.0}, 1.0));
  for (double last = 0.0; strategy.proximal() > last;) {
    last = strategy.proximal();
    ASSERT_TRUE(strategy.reject_line_search());
  }
  EXPECT_EQ(strategy.proximal(), config.proximal_start);
  EXPECT_TRUE(strategy.accept({0.2, 1.0}, {0.1, 1.0}, 1.0));
}

TEST(SqpStrategy, ProximalTermFollowsTheStepLength) {
  const ReverseConfig config;
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
  const ReverseConfig config;
  SqpStrategy strategy(config);
  strategy.reject_ascent();
  ASSERT_FALSE(strategy.uses_lagrangian());
  EXPECT_TRUE(strategy.accept({1.0, 0.0}, {0.5, 0.0}, 1.0));
  EXPECT_TRUE(strategy.uses_lagrangian());
}

TEST(SqpStrategy, ATrialPointMustImproveAndBeNewToTheFilter) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  EXPECT_FALSE(strategy.accept({0.1, 1.0}, {0.1, 1.0}, 1.0));   // as now
  EXPECT_FALSE(strategy.accept({0.1, 1.0}, {0.35, 0.0}, 1.0));  // far from feasible
  EXPECT_FALSE(strategy.accept({0.1, 1.0}, {0.05, NAN}, 1.0));
  EXPECT_TRUE(strategy.accept({0.1, 1.0}, {0.25, 0.5}, 1.0));
  EXPECT_FALSE(strategy.accept({0.25, 0.5}, {0.1, 1.0}, 1.0));  // where it came from
  EXPECT_TRUE(strategy.accept({0.25, 0.5}, {0.05, 1.0}, 1.0));
  EXPECT_TRUE(strategy.accept({0.8, 0.0}, {0.7, 0.0}, 1.0));  // no farther than it was
}

TEST(SqpStrategy, RestoresFeasibilityWhereNoProximalWeightHelpsUnlessNothingCameOfIt) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  ASSERT_TRUE(strategy.accept({0.1, 1.0}, {0.05, 1.0}, 1.0));
  ASSERT_FALSE(strategy.accept({0.05, 1.0}, {0.1, 1.0}, 1.0));  // known to the filter
  double before = 0.0;
  for (; strategy.proximal() > before; strategy.reject_line_search()) {
    EXPECT_FALSE(strategy.take_restoration());
    before = strategy.proximal();
  }
  EXPECT_GT(before, 1e5);
  EXPECT_EQ(strategy.proximal(), config.proximal_start);
  EXPECT_TRUE(strategy.take_restoration());
  EXPECT_FALSE(strategy.take_restoration());
  EXPECT_TRUE(strategy.accept({0.2, 1.0}, {0.1, 1.0}, 1.0));  // the filter is empty
  int more = 0;
  while (!strategy.take_restoration()) {
    ASSERT_LT(++more, 100);
    ASSERT_TRUE(strategy.reject_line_search());
  }
  more = 0;
  while (strategy.reject_line_search()) ++more;
  EXPECT_GT(more, 5);
  EXPECT_EQ(strategy.status(), SolveStatus::kLineSearchFailed);
  EXPECT_FALSE(strategy.take_restoration());
}

TEST(SqpStrategy, SolvesTenSystemsAgainAtMost) {
  const ReverseConfig config;
  SqpStrategy strategy(config);
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(strategy.may_pivot()) << k;
  EXPECT_FALSE(strategy.may_pivot());
}

}  // namespace
}  // namespace rtg::reverse
