#include "core/learn/double_dqn.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace rtg::learn {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::RowVectorXf;
using Eigen::VectorXf;

constexpr NetworkSizes kSizes{.inputs = 5, .headings = 12, .hidden = 16, .features = 8};
constexpr float kNone = -std::numeric_limits<float>::infinity();

/// Two random networks and random transitions: every third is final, every fifth has a bound.
struct Case {
  VectorXf online, target;
  MatrixXf states, next;
  std::vector<std::int64_t> actions;
  RowVectorXf rewards, terminated, bounds;

  explicit Case(int count) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const auto draw = [&] { return normal(random); };
    for (VectorXf* weights : {&online, &target})
      *weights = 0.3f * VectorXf::NullaryExpr(weight_count(kSizes), draw);
    for (MatrixXf* each : {&states, &next})
      *each = MatrixXf::NullaryExpr(kSizes.inputs, count, draw);
    rewards = RowVectorXf::NullaryExpr(count, draw);
    terminated = RowVectorXf::Zero(count);
    bounds = RowVectorXf::Constant(count, kNone);
    for (int k = 0; k < count; ++k) {
      actions.push_back(7 * k % kSizes.headings);
      if (k % 3 == 0) terminated[k] = 1.0f;
      if (k % 5 == 0) bounds[k] = 0.5f;
    }
  }

  /// Returns the gradient.
  VectorXf compute(DoubleDqn& learner, int threads = 1) const {
    learner.compute(online.data(), target.data(), batch(), threads);
    return learner.gradient();
  }

  Transitions batch() const {
    const auto map = [](const RowVectorXf& x) { return Transitions::Numbers(x.data(), x.size()); };
    return {{states.data(), states.rows(), states.cols()},
            actions,
            {next.data(), next.rows(), next.cols()},
            map(rewards),
            map(terminated),
            map(bounds)};
  }
};

/// V(s') of transition k as the header says, from the values of all headings.
float next_value(const TargetRules& rules, const MatrixXf& online, const MatrixXf& target,
                 Index k) {
  Index best = 0;
  const float most = online.col(k).maxCoeff(&best);
  if (!rules.double_q) return target.col(k).maxCoeff();
  return rules.clipped_double_q ? std::min(most, target(best, k)) : target(best, k);
}

// For batches of one transition, of an odd and of an even number.
TEST(DoubleDqn, TargetsAreThoseOfAPlainLoop) {
  for (const int count : {1, 21, 30}) {
    const Case c(count);
    HeadingNetwork network(kSizes);
    const HeadingNetwork::States next(c.next.data(), c.next.rows(), c.next.cols());
    const MatrixXf online = network.values(c.online.data(), next);
    const MatrixXf target = network.values(c.target.data(), next);
    const HeadingNetwork::States states(c.states.data(), c.states.rows(), c.states.cols());
    const MatrixXf here = network.values(c.online.data(), states);
    for (const TargetRules rules : {TargetRules{0.9, true, true, true},
                                    {0.9, true, true, false},
                                    {0.9, true, false, false},
                                    {0.9, false, true, false},
                                    {0.9, false, false, true}}) {
      DoubleDqn learner(kSizes, rules);
      c.compute(learner);
      for (int k = 0; k < count; ++k) {
        const float bootstrap =
            c.rewards[k] + 0.9f * (1.0f - c.terminated[k]) * next_value(rules, online, target, k);
        float y = std::max(bootstrap, c.bounds[k]);
        if (rules.clip_targets) y = std::clamp(y, 0.0f, 1.0f);
        EXPECT_NEAR(learner.bootstrap()[k], bootstrap, 1e-4) << k;
        EXPECT_NEAR(learner.targets()[k], y, 1e-4) << k;
        const auto row = static_cast<std::size_t>(k);
        EXPECT_NEAR(learner.values()[k], here(c.actions[row], k), 1e-4) << k;
      }
    }
  }
}

/// L for the targets y.
double loss(const RowVectorXf& q, const RowVectorXf& y) {
  double sum = 0.0;
  for (Index k = 0; k < q.size(); ++k) {
    const double e = std::abs(static_cast<double>(q[k]) - y[k]);
    sum += e <= 1.0 ? 0.5 * e * e : e - 0.5;
  }
  return sum / static_cast<double>(q.size());
}

// Of a batch of one the second half, which has a gradient of its own, is empty.
TEST(DoubleDqn, ATransitionTwiceHasTheGradientOfOne) {
  Case one(1), two(2);
  two.states.col(1) = two.states.col(0) = one.states;
  two.next.col(1) = two.next.col(0) = one.next;
  two.actions[1] = two.actions[0] = one.actions[0];
  two.rewards.fill(one.rewards[0]);
  two.terminated.fill(one.terminated[0]);
  two.bounds.fill(one.bounds[0]);
  two.online = one.online;
  two.target = one.target;
  DoubleDqn learner(kSizes, {0.9, true, true, false}), other(kSizes, {0.9, true, true, false});
  const VectorXf gradient = one.compute(learner);
  EXPECT_LT((gradient - two.compute(other)).norm(), 1e-5f * gradient.norm());
  EXPECT_GT(gradient.norm(), 0.1f);
}

// By central differences along the gradient, and along it with random signs: the change of Q(s, a)
// counts, the targets do not. Errors are on both sides of 1, where the loss goes straight.
TEST(DoubleDqn, GradientIsThatOfTheLossWithFixedTargets) {
  Case c(21);
  DoubleDqn learner(kSizes, {0.9, true, true, false});
  const VectorXf gradient = c.compute(learner), start = c.online;
  const RowVectorXf y = learner.targets();
  const auto errors = (learner.values() - y).array().abs();
  EXPECT_LT(errors.minCoeff(), 0.8f);
  EXPECT_GT(errors.maxCoeff(), 1.2f);
  std::mt19937 random(1);
  for (int turn = 0; turn < 8; ++turn) {
    VectorXf way = gradient.normalized();
    if (turn > 0) way = way.unaryExpr([&](float x) { return random() % 2 == 0 ? x : -x; });
    const auto at = [&](float length) {
      c.online = start + length * way;
      c.compute(learner);
      return loss(learner.values(), y);
    };
    const float step = 2e-3f;
    const double slope = (at(step) - at(-step)) / (2.0 * step);
    EXPECT_NEAR(slope, gradient.dot(way), 0.02 * gradient.norm()) << turn;
  }
  EXPECT_GT(gradient.norm(), 0.1f);
}

TEST(DoubleDqn, TwoThreadsComputeTheSameBits) {
  const Case c(129);
  DoubleDqn learner(kSizes, {});
  const VectorXf gradient = c.compute(learner);
  const RowVectorXf values = learner.values(), targets = learner.targets();
  for (const int threads : {2, 5}) {
    EXPECT_EQ(c.compute(learner, threads), gradient);
    EXPECT_EQ(learner.values(), values);
    EXPECT_EQ(learner.targets(), targets);
  }
}

}  // namespace
}  // namespace rtg::learn
