#include "core/learn/heading_network.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace rtg::learn {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::RowVectorXf;

/// Writes the layer's outputs for a batch of inputs.
void apply(const Linear<const float>& layer, const MatrixXf& in, MatrixXf& out) {
  out.noalias() = layer.weight * in;
  out.colwise() += layer.bias;
}

/// Writes the gradient for the weights of a layer, from that for its outputs.
template <class Gradient>
void pull_back(const MatrixXf& in, const Gradient& of_out, Linear<float> of_weights) {
  of_weights.weight.noalias() = of_out * in.transpose();
  of_weights.bias = of_out.rowwise().sum();
}

}  // namespace

HeadingNetwork::HeadingNetwork(const NetworkSizes& sizes)
    : sizes_(sizes),
      basis_(3, sizes.headings),
      all_(static_cast<std::size_t>(sizes.headings)),
      gradient_(weight_count(sizes)) {
  std::iota(all_.begin(), all_.end(), std::int64_t{0});
  for (int a = 0; a < sizes.headings; ++a) {
    const double theta = 2.0 * std::numbers::pi * a / sizes.headings;
    basis_.col(a) << 1.0f, static_cast<float>(std::cos(theta)), static_cast<float>(std::sin(theta));
  }
}

void HeadingNetwork::trunk(const Weights& weights, const States& states) {
  states_ = states;  // aligned
  apply(weights.first, states_, first_);
  first_norm_.apply(weights.first_norm, first_);
  apply(weights.second, first_, second_);
  second_norm_.apply(weights.second_norm, second_);
  apply(weights.features, second_, features_);
}

/// Writes w + cos θ_a u + sin θ_a v of a state, for each of the headings a, into along_ from
/// `column` on.
void HeadingNetwork::features_along(Index state, Headings headings, Index column) {
  const Eigen::Map<const MatrixXf> wuv(features_.col(state).data(), sizes_.features, 3);
  for (const std::int64_t heading : headings)
    along_.col(column++) = wuv.lazyProduct(basis_.col(heading));
}

/// Writes the outputs of f's first NormRelu over its inputs, along_, and those of its ReLU to
/// inner_.
void HeadingNetwork::inner_layer(const Weights& weights) {
  along_norm_.apply(weights.along_norm, along_);
  apply(weights.along, along_, inner_);
  inner_ = inner_.cwiseMax(0.0f);
}

const MatrixXf& HeadingNetwork::values(const float* array, const States& states) {
  constexpr Index kTogether = 8;  // the values of so many states within f stay in the cache
  const Weights weights(sizes_, array);
  ++calls_;
  last_call_.reset();
  trunk(weights, states);
  all_values_.resize(sizes_.headings, states.cols());
  const RowVectorXf value =
      (weights.value.weight * second_).array() + weights.value.bias[0] + weights.advantage.bias[0];
  for (Index begin = 0; begin < states.cols(); begin += kTogether) {
    const Index count = std::min(kTogether, states.cols() - begin);
    along_.resize(sizes_.features, count * sizes_.headings);
    for (Index k = 0; k < count; ++k) features_along(begin + k, all_, k * sizes_.headings);
    inner_layer(weights);
    Eigen::Map<RowVectorXf>(all_values_.col(begin).data(), inner_.cols()).noalias() =
        weights.advantage.weight * inner_;
    all_values_.middleCols(begin, count).rowwise() += value.segment(begin, count);
  }
  return all_values_;
}

const RowVectorXf& HeadingNetwork::values_at(const float* array, const States& states,
                                             Headings headings) {
  const Weights weights(sizes_, array);
  headings_.assign(headings.begin(), headings.end());
  last_call_ = {calls_++, states.cols()};
  trunk(weights, states);
  along_.resize(sizes_.features, states.cols());
  for (Index k = 0; k < states.cols(); ++k)
    features_along(k, headings.subspan(static_cast<std::size_t>(k), 1), k);
  inner_layer(weights);
  values_ = (weights.value.weight * second_ + weights.advantage.weight * inner_).array() +
            weights.value.bias[0] + weights.advantage.bias[0];
  return values_;
}

const Eigen::VectorXf& HeadingNetwork::gradient(const float* array,
                                                const Eigen::Map<const RowVectorXf>& unaligned) {
  const Weights weights(sizes_, array);
  const HeadingWeights<float> out(sizes_, gradient_.data());
  const RowVectorXf of_q = unaligned;
  pull_back(inner_, of_q, out.advantage);
  pull_back(second_, of_q, out.value);

  MatrixXf of_inner = weights.advantage.weight.transpose() * of_q;
  of_inner = (inner_.array() > 0.0f).select(of_inner, 0.0f);
  pull_back(along_, of_inner, out.along);

  MatrixXf of_along = weights.along.weight.transpose() * of_inner;
  along_norm_.pull_back(weights.along_norm, along_, of_along, out.along_norm);

  MatrixXf of_features(features_.rows(), features_.cols());
  for (Index k = 0; k < of_features.cols(); ++k) {
    const auto basis = basis_.col(headings_[static_cast<std::size_t>(k)]);
    Eigen::Map<MatrixXf>(of_features.col(k).data(), sizes_.features, 3) =
        of_along.col(k).lazyProduct(basis.transpose());
  }
  pull_back(second_, of_features, out.features);

  MatrixXf of_second = weights.features.weight.transpose() * of_features;
  of_second.noalias() += weights.value.weight.transpose() * of_q;
  second_norm_.pull_back(weights.second_norm, second_, of_second, out.second_norm);
  pull_back(first_, of_second, out.second);

  MatrixXf of_first = weights.second.weight.transpose() * of_second;
  first_norm_.pull_back(weights.first_norm, first_, of_first, out.first_norm);
  pull_back(states_, of_first, out.first);
  return gradient_;
}

}  // namespace rtg::learn
