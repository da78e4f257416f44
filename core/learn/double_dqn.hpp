#pragma once

#include <array>

#include "core/learn/heading_network.hpp"

namespace rtg::learn {

/// The transitions (s, a, r, s') of a gradient step, B of them. States have a column for each,
/// [inputs, B]; all else is [B].
struct Transitions {
  using Numbers = Eigen::Map<const Eigen::RowVectorXf>;

  HeadingNetwork::States states;
  HeadingNetwork::Actions actions;
  HeadingNetwork::States next_states;
  Numbers rewards;
  Numbers terminated;  // T; 1: no bootstrap from s'
  Numbers bounds;      // b, lower bounds of Q*(s, a); -∞ where there is none
};

/// How Q(s', ·) becomes a target, as settings of the same names say.
struct TargetRules {
  double discount = 0.0;  // γ
  bool double_q = true;
  bool clipped_double_q = true;
  bool clip_targets = true;
};

/// The loss of Double Q-learning [van Hasselt et al. 2016] and its gradient for the weights of a
/// HeadingNetwork, the online network:
///
///   L = mean Huber(Q(s, a) - y),   y = max(r + γ (1 - T) V(s'), b).
///
/// With clip_targets, y is clipped to [0, 1]. V(s') = Q⁻(s', argmax Q(s', ·)), where Q⁻ is the
/// target network; with clipped_double_q, it is the smaller one of Q and Q⁻; without double_q,
/// max Q⁻(s', ·). Huber(e) = e²/2 up to |e| = 1, then |e| - 1/2.
///
/// Two threads take a half of the batch each. Results are the same with one, bit for bit.
class DoubleDqn {
 public:
  DoubleDqn(const NetworkSizes& sizes, const TargetRules& rules,
            const std::vector<double>& strides = {1.0});

  const HeadingNetwork& network() const { return networks_[0]; }

  /// Computes L's gradient for the weights `online` and what it depends on. `online` and `target`
  /// are weights as HeadingNetwork takes them. 1 ≤ `threads`.
  void compute(const float* online, const float* target, const Transitions& batch, int threads);

  // Of the last compute().
  const Eigen::VectorXf& gradient() const { return gradients_[0]; }   // [weights]
  const Eigen::RowVectorXf& values() const { return values_; }        // Q(s, a) [B]
  const Eigen::RowVectorXf& bootstrap() const { return bootstrap_; }  // r + γ (1 - T) V(s') [B]
  const Eigen::RowVectorXf& targets() const { return targets_; }      // y [B]

 private:
  void compute_part(HeadingNetwork& network, const float* online, const float* target,
                    const Transitions& batch, Eigen::Index begin, Eigen::Index count,
                    float* gradient);
  Eigen::RowVectorXf next_values(HeadingNetwork& network, const float* online, const float* target,
                                 const HeadingNetwork::States& next) const;

  TargetRules rules_;
  // For either half of the batch. In the end, the first gradient is their sum.
  std::array<HeadingNetwork, 2> networks_;
  std::array<Eigen::VectorXf, 2> gradients_;
  Eigen::RowVectorXf values_, bootstrap_, targets_;
};

}  // namespace rtg::learn
