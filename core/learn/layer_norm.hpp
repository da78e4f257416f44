#pragma once

#include <cmath>

#include "core/learn/heading_weights.hpp"

namespace rtg::learn {

constexpr float kVarianceFloor = 1e-5f;  // PyTorch's

/// Replaces ∂L/∂y by ∂L/∂x of y = max(x, 0).
inline void pull_back_relu(const Eigen::MatrixXf& y, Eigen::MatrixXf& gradient) {
  // Eigen's select() branches on each entry, and half of the branches are mispredicted.
  const float* const from = y.data();
  float* const to = gradient.data();
  for (Eigen::Index k = 0; k < y.size(); ++k) to[k] = from[k] > 0.0f ? to[k] : 0.0f;
}

/// Layer normalisation [Ba et al. 2016] followed by ReLU, for a batch with a column per sample:
///
///   y = max(γ x̂ + β, 0),   x̂ = (x - mean x) / σ,   σ² = var x + kVarianceFloor.
///
/// Keeps what the gradient needs.
class NormRelu {
 public:
  /// Replaces each column x of `batch` by y.
  void apply(const Norm<const float>& norm, Eigen::MatrixXf& batch) {
    normal_.resize(batch.rows(), batch.cols());
    inverse_sigma_.resize(batch.cols());
    for (Eigen::Index k = 0; k < batch.cols(); ++k) {
      auto x = batch.col(k).array();
      x -= x.mean();
      inverse_sigma_[k] = 1.0f / std::sqrt(x.square().mean() + kVarianceFloor);
      auto normal = normal_.col(k).array();
      normal = x * inverse_sigma_[k];
      x = (normal * norm.scale.array() + norm.shift.array()).max(0.0f);
    }
  }

  /// Replaces each column ∂L/∂y of `of_batch` by ∂L/∂x and writes ∂L/∂γ, ∂L/∂β to `of_weights`.
  /// `y`: the batch after the last apply().
  void pull_back(const Norm<const float>& norm, const Eigen::MatrixXf& y, Eigen::MatrixXf& of_batch,
                 Norm<float> of_weights) const {
    pull_back_relu(y, of_batch);
    of_weights.scale = (of_batch.array() * normal_.array()).rowwise().sum();
    of_weights.shift = of_batch.rowwise().sum();
    for (Eigen::Index k = 0; k < of_batch.cols(); ++k) {
      auto d = of_batch.col(k).array();
      const auto normal = normal_.col(k).array();
      d *= norm.scale.array();  // ∂L/∂x̂
      const float mean = d.mean(), along = (d * normal).mean();
      d = (d - mean - along * normal) * inverse_sigma_[k];
    }
  }

 private:
  Eigen::MatrixXf normal_;         // x̂
  Eigen::VectorXf inverse_sigma_;  // 1/σ of each column
};

}  // namespace rtg::learn
