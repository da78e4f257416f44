#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/learn/layer_norm.hpp"

namespace rtg::learn {

/// The value network of pushes, as train/rtg/learn/networks.py defines it. With headings
/// θ_a = 2πa/n and strides ℓ_k, k = ⌊a/n⌋, in units of the longest one, it is
///
///   Q(s, a) = V(h) + f(w(h) + ℓ_k cos θ_a u(h) + ℓ_k sin θ_a v(h)),   h = trunk(s).
///
/// The trunk has two layers, each linear, NormRelu. V, w, u and v are linear, and f is NormRelu,
/// linear, ReLU, linear. PyTorch takes about 1.6 times as long: each of its many small operations
/// has a cost of its own and passes over all of its operands.
///
/// A batch of B states has a column per state, [inputs, B]. `weights` are those of HeadingWeights,
/// aligned to 64 bytes as PyTorch's tensors are: results are the same, bit for bit, for the same
/// arguments. Results are valid until the next call. One thread at a time may use a network.
class HeadingNetwork {
 public:
  using States = Eigen::Map<const Eigen::MatrixXf>;
  using Actions = std::span<const std::int64_t>;

  /// `strides`: ℓ_k.
  explicit HeadingNetwork(const NetworkSizes& sizes, const std::vector<double>& strides = {1.0});

  const NetworkSizes& sizes() const { return sizes_; }
  int actions() const { return static_cast<int>(basis_.cols()); }

  /// Returns Q of all actions. [actions, B]
  const Eigen::MatrixXf& values(const float* weights, const States& states);

  /// Returns Q of one action per state. [B]
  const Eigen::RowVectorXf& values_at(const float* weights, const States& states, Actions actions);

  /// Writes the gradient of a loss L for the weights to `out`, an array like theirs, from `of_q` =
  /// ∂L/∂q [B]. The last call must have been values_at(), with the same weights, and q its result.
  void gradient(const float* weights, const Eigen::RowVectorXf& of_q, float* out) const;

 private:
  using Weights = HeadingWeights<const float>;

  void trunk(const Weights& weights, const States& states);
  void normal_along_all(const Weights& weights, Eigen::Index state, Eigen::Index column);
  void inner_layer(const Weights& weights);

  NetworkSizes sizes_;
  Eigen::Matrix3Xf basis_;             // (1, ℓ_k cos θ_a, ℓ_k sin θ_a) [3, actions]
  std::vector<std::int64_t> actions_;  // of the last values_at()
  NormRelu first_norm_, second_norm_, along_norm_;
  // Of the last batch: states; outputs of the layers of the trunk; w, u and v; outputs of NormRelu
  // and ReLU in f.
  Eigen::MatrixXf states_, first_, second_, features_, along_, inner_;
  Eigen::MatrixXf all_values_;
  Eigen::RowVectorXf values_;
};

}  // namespace rtg::learn
