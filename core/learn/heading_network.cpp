#include "core/learn/heading_network.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rtg::learn {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::RowVectorXf;

/// Writes the layer's outputs for a batch of inputs.
void apply(const Linear<const float>& layer, const MatrixXf& in, MatrixXf& out) {
  out.resize(layer.bias.size(), in.cols());
  out.colwise() = layer.bias;
  out.noalias() += layer.weight * in;
}

/// Writes the gradient for the weights of a layer, from that for its outputs.
template <class Gradient>
void pull_back(const MatrixXf& in, const Gradient& of_out, Linear<float> of_weights) {
  of_weights.weight.noalias() = of_out * in.transpose();
  of_weights.bias = of_out.rowwise().sum();
}

}  // namespace

HeadingNetwork::HeadingNetwork(const NetworkSizes& sizes, const std::vector<double>& strides)
    : sizes_(sizes), basis_(3, sizes.headings * static_cast<int>(strides.size())) {
  for (int a = 0; a < actions(); ++a) {
    const double theta = 2.0 * std::numbers::pi * (a % sizes.headings) / sizes.headings;
    const double stride = strides[static_cast<std::size_t>(a / sizes.headings)];
    basis_.col(a) << 1.0f, static_cast<float>(stride * std::cos(theta)),
        static_cast<float>(stride * std::sin(theta));
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

/// Writes NormRelu of w + ℓ_k cos θ_a u + ℓ_k sin θ_a v of a state, for all actions a, into along_
/// from `column` on.
///
/// With b_a = (1, ℓ_k cos θ_a, ℓ_k sin θ_a), and the features less their means as X = (w, u, v),
/// mean and variance over the features are 0 and b_aᵀ (XᵀX / features) b_a. So they take no pass
/// over the features of each action.
void HeadingNetwork::normal_along_all(const Weights& weights, Index state, Index column) {
  using Features = Eigen::MatrixX3f;
  Features x = Eigen::Map<const Features>(features_.col(state).data(), sizes_.features, 3);
  x.rowwise() -= x.colwise().mean().eval();
  const Eigen::Matrix3f covariance = x.transpose() * x / static_cast<float>(sizes_.features);
  const auto variance = (covariance * basis_).cwiseProduct(basis_).colwise().sum().array();
  const Eigen::Matrix3Xf scaled =
      basis_.array().rowwise() / (variance + kVarianceFloor).sqrt().eval();
  x.array().colwise() *= weights.along_norm.scale.array();
  auto out = along_.middleCols(column, actions());
  out = x.lazyProduct(scaled);
  out = (out.colwise() + weights.along_norm.shift).cwiseMax(0.0f);
}

/// Writes the outputs of f's ReLU over those of its NormRelu, along_, to inner_.
void HeadingNetwork::inner_layer(const Weights& weights) {
  apply(weights.along, along_, inner_);
  inner_ = inner_.cwiseMax(0.0f);
}

const MatrixXf& HeadingNetwork::values(const float* array, const States& states) {
  constexpr Index kTogether = 8;  // the values of so many states within f stay in the cache
  const Weights weights(sizes_, array);
  trunk(weights, states);
  all_values_.resize(actions(), states.cols());
  const Eigen::Map<const Eigen::VectorXf> advantage(weights.advantage.weight.data(),
                                                    sizes_.features);
  const RowVectorXf value =
      (weights.value.weight * second_).array() + weights.value.bias[0] + weights.advantage.bias[0];
  for (Index begin = 0; begin < states.cols(); begin += kTogether) {
    const Index count = std::min(kTogether, states.cols() - begin);
    along_.resize(sizes_.features, count * actions());
    for (Index k = 0; k < count; ++k) normal_along_all(weights, begin + k, k * actions());
    apply(weights.along, along_, inner_);
    for (Index k = 0; k < count; ++k)
      for (Index a = 0; a < actions(); ++a)
        all_values_(a, begin + k) =
            value[begin + k] + advantage.dot(inner_.col(k * actions() + a).cwiseMax(0.0f));
  }
  return all_values_;
}

const RowVectorXf& HeadingNetwork::values_at(const float* array, const States& states,
                                             Actions actions) {
  const Weights weights(sizes_, array);
  actions_.assign(actions.begin(), actions.end());
  trunk(weights, states);
  along_.resize(sizes_.features, states.cols());
  for (Index k = 0; k < states.cols(); ++k) {
    const Eigen::Map<const Eigen::MatrixX3f> wuv(features_.col(k).data(), sizes_.features, 3);
    along_.col(k) = wuv.lazyProduct(basis_.col(actions[static_cast<std::size_t>(k)]));
  }
  along_norm_.apply(weights.along_norm, along_);
  inner_layer(weights);
  values_ = (weights.value.weight * second_ + weights.advantage.weight * inner_).array() +
            weights.value.bias[0] + weights.advantage.bias[0];
  return values_;
}

void HeadingNetwork::gradient(const float* array, const RowVectorXf& of_q, float* of_array) const {
  const Weights weights(sizes_, array);
  const HeadingWeights<float> out(sizes_, of_array);
  pull_back(inner_, of_q, out.advantage);
  pull_back(second_, of_q, out.value);

  MatrixXf of_inner = weights.advantage.weight.transpose() * of_q;
  pull_back_relu(inner_, of_inner);
  pull_back(along_, of_inner, out.along);

  MatrixXf of_along = weights.along.weight.transpose() * of_inner;
  along_norm_.pull_back(weights.along_norm, along_, of_along, out.along_norm);

  MatrixXf of_features(features_.rows(), features_.cols());
  for (Index k = 0; k < of_features.cols(); ++k) {
    const auto basis = basis_.col(actions_[static_cast<std::size_t>(k)]);
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
}

}  // namespace rtg::learn
