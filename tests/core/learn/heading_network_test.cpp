#include "core/learn/heading_network.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace rtg::learn {
namespace {

using Eigen::MatrixXf;
using Eigen::RowVectorXf;
using Eigen::VectorXf;

constexpr NetworkSizes kSizes{.inputs = 5, .headings = 12, .hidden = 16, .features = 8};

constexpr int kActions = 24;  // with two strides

/// Random weights and a batch of random states, each with an action.
struct Case {
  HeadingNetwork network{kSizes, {0.4, 1.0}};
  VectorXf weights;
  MatrixXf states;
  std::vector<std::int64_t> actions;

  explicit Case(int count) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    weights = VectorXf::NullaryExpr(weight_count(kSizes), [&] { return 0.5f * normal(random); });
    states = MatrixXf::NullaryExpr(kSizes.inputs, count, [&] { return normal(random); });
    for (int k = 0; k < count; ++k) actions.push_back(7 * k % kActions);
  }

  HeadingNetwork::States batch() const { return {states.data(), states.rows(), states.cols()}; }
  RowVectorXf at() { return network.values_at(weights.data(), batch(), actions); }
  VectorXf gradient(const RowVectorXf& of_q) {
    VectorXf out(weights.size());
    network.gradient(weights.data(), of_q, out.data());
    return out;
  }
  MatrixXf all() { return network.values(weights.data(), batch()); }
};

TEST(HeadingNetwork, WeightsFillTheirArray) {
  std::vector<float> array(static_cast<std::size_t>(weight_count(kSizes)));
  const HeadingWeights<float> weights(kSizes, array.data());
  EXPECT_EQ(weights.first.weight.data(), array.data());
  EXPECT_EQ(weights.advantage.bias.data(), &array.back());
}

// For batches of one state, of fewer and of more states than are computed together.
TEST(HeadingNetwork, ValuesOfAllActionsAreThoseOfEach) {
  for (const int count : {1, 5, 8, 21}) {
    Case c(count);
    const MatrixXf all = c.all();
    EXPECT_GT(all.maxCoeff() - all.minCoeff(), 0.1f);
    for (int turn = 0; turn < kActions; ++turn) {
      const RowVectorXf q = c.at();
      for (int k = 0; k < count; ++k)
        EXPECT_NEAR(q[k], all(c.actions[static_cast<std::size_t>(k)], k), 1e-5) << count;
      for (std::int64_t& action : c.actions) action = (action + 1) % kActions;
    }
  }
}

struct Block {
  const char* name;
  Eigen::Index begin, size;  // in the array of all weights
};

/// The vectors and matrices that the weights consist of.
std::vector<Block> blocks() {
  std::vector<float> array(static_cast<std::size_t>(weight_count(kSizes)));
  const HeadingWeights<float> w(kSizes, array.data());
  std::vector<Block> out;
  const auto add = [&](const char* name, const auto& view) {
    out.push_back({name, view.data() - array.data(), view.size()});
  };
  for (const auto& [name, layer] : {std::pair("first", &w.first),
                                    {"second", &w.second},
                                    {"features", &w.features},
                                    {"value", &w.value},
                                    {"along", &w.along},
                                    {"advantage", &w.advantage}}) {
    add(name, layer->weight);
    add(name, layer->bias);
  }
  for (const auto& [name, norm] : {std::pair("first_norm", &w.first_norm),
                                   {"second_norm", &w.second_norm},
                                   {"along_norm", &w.along_norm}}) {
    add(name, norm->scale);
    add(name, norm->shift);
  }
  return out;
}

// By central differences of L = of_q·q, of every weight.
TEST(HeadingNetwork, GradientIsThatOfTheLoss) {
  Case c(21);
  const RowVectorXf of_q = RowVectorXf::LinSpaced(21, -1.0f, 2.0f);
  c.at();
  const VectorXf gradient = c.gradient(of_q);
  Eigen::Index tested = 0;
  for (const auto& [name, begin, size] : blocks()) {
    Eigen::Index close = 0;
    for (Eigen::Index k = begin; k < begin + size; ++k) {
      const float step = 2e-3f, weight = c.weights[k];
      const auto loss = [&](float value) {
        c.weights[k] = value;
        return c.at().cast<double>().dot(of_q.cast<double>());
      };
      const double difference = (loss(weight + step) - loss(weight - step)) / (2.0 * step);
      c.weights[k] = weight;
      close += std::abs(difference - gradient[k]) < 0.02 + 0.02 * std::abs(gradient[k]);
    }
    // Where a ReLU switches within the step, differences are wrong.
    EXPECT_GE(close, size - size / 8) << name;
    EXPECT_GT(gradient.segment(begin, size).cwiseAbs().maxCoeff(), 0.05f) << name;
    tested += size;
  }
  EXPECT_EQ(tested, c.weights.size());
}

// States need no alignment for that.
TEST(HeadingNetwork, ResultsAreTheSameBitForBit) {
  Case c(21);
  const MatrixXf all = c.all();
  const RowVectorXf q = c.at();
  const VectorXf gradient = c.gradient(q);
  for (int shift = 0; shift < 4; ++shift) {
    VectorXf states(shift + c.states.size());
    states.tail(c.states.size()) = c.states.reshaped();
    const HeadingNetwork::States batch(states.data() + shift, kSizes.inputs, 21);
    EXPECT_EQ(c.network.values(c.weights.data(), batch), all);
    EXPECT_EQ(c.network.values_at(c.weights.data(), batch, c.actions), q);
    EXPECT_EQ(c.gradient(q), gradient);
  }
}

}  // namespace
}  // namespace rtg::learn
