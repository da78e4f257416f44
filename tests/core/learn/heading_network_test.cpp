#include "core/learn/heading_network.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace rtg::learn {
namespace {

using Eigen::MatrixXf;
using Eigen::RowVectorXf;
using Eigen::VectorXf;

constexpr NetworkSizes kSizes{.inputs = 5, .headings = 12, .hidden = 16, .features = 8};

/// Random weights and a batch of random states, each with a heading.
struct Case {
  HeadingNetwork network{kSizes};
  VectorXf weights;
  MatrixXf states;
  std::vector<std::int64_t> headings;

  explicit Case(int count) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    weights = VectorXf::NullaryExpr(weight_count(kSizes), [&] { return 0.5f * normal(random); });
    states = MatrixXf::NullaryExpr(kSizes.inputs, count, [&] { return normal(random); });
    for (int k = 0; k < count; ++k) headings.push_back(7 * k % kSizes.headings);
  }

  HeadingNetwork::States batch() const { return {states.data(), states.rows(), states.cols()}; }
  RowVectorXf at() { return network.values_at(weights.data(), batch(), headings); }
  MatrixXf all() { return network.values(weights.data(), batch()); }
};

TEST(HeadingNetwork, WeightsFillTheirArray) {
  std::vector<float> array(static_cast<std::size_t>(weight_count(kSizes)));
  const HeadingWeights<float> weights(kSizes, array.data());
  EXPECT_EQ(weights.first.weight.data(), array.data());
  EXPECT_EQ(weights.advantage.bias.data(), &array.back());
}

// For batches of one state, of fewer and of more states than are computed together.
TEST(HeadingNetwork, ValuesOfAllHeadingsAreThoseOfEach) {
  for (const int count : {1, 5, 8, 21}) {
    Case c(count);
    const MatrixXf all = c.all();
    EXPECT_GT(all.maxCoeff() - all.minCoeff(), 0.1f);
    for (int turn = 0; turn < kSizes.headings; ++turn) {
      const RowVectorXf q = c.at();
      for (int k = 0; k < count; ++k)
        EXPECT_NEAR(q[k], all(c.headings[static_cast<std::size_t>(k)], k), 1e-5) << count;
      for (std::int64_t& heading : c.headings) heading = (heading + 1) % kSizes.headings;
    }
  }
}

// By central differences of L = slope·q, of every weight.
TEST(HeadingNetwork, GradientIsTheSlopeOfTheLoss) {
  Case c(21);
  const RowVectorXf slope = RowVectorXf::LinSpaced(21, -1.0f, 2.0f);
  c.at();
  const VectorXf gradient = c.network.gradient(c.weights.data(), {slope.data(), slope.size()});
  int close = 0;
  for (Eigen::Index k = 0; k < c.weights.size(); ++k) {
    const float step = 2e-3f, weight = c.weights[k];
    const auto loss = [&](float value) {
      c.weights[k] = value;
      return c.at().cast<double>().dot(slope.cast<double>());
    };
    const double difference = (loss(weight + step) - loss(weight - step)) / (2.0 * step);
    c.weights[k] = weight;
    close += std::abs(difference - gradient[k]) < 0.02 + 0.02 * std::abs(gradient[k]);
  }
  // Where a ReLU switches within the step, differences are wrong.
  EXPECT_GT(close, 0.97 * static_cast<double>(c.weights.size()));
}

// States and slopes need no alignment for that.
TEST(HeadingNetwork, ResultsAreTheSameBitForBit) {
  Case c(21);
  const MatrixXf all = c.all();
  const RowVectorXf q = c.at();
  const VectorXf gradient = c.network.gradient(c.weights.data(), {q.data(), q.size()});
  for (int shift = 0; shift < 4; ++shift) {
    VectorXf states(shift + c.states.size()), slope(shift + q.size());
    states.tail(c.states.size()) = c.states.reshaped();
    slope.tail(q.size()) = q.transpose();
    const HeadingNetwork::States batch(states.data() + shift, kSizes.inputs, 21);
    EXPECT_EQ(c.network.values(c.weights.data(), batch), all);
    EXPECT_EQ(c.network.values_at(c.weights.data(), batch, c.headings), q);
    EXPECT_EQ(c.network.gradient(c.weights.data(), {slope.data() + shift, q.size()}), gradient);
  }
}

TEST(HeadingNetwork, KeepsWhatTheGradientNeedsUntilTheNextCall) {
  Case c(3);
  EXPECT_EQ(c.network.kept(), 0);
  c.at();
  EXPECT_EQ(c.network.kept(), 3);
  c.all();
  EXPECT_EQ(c.network.kept(), 0);
}

}  // namespace
}  // namespace rtg::learn
