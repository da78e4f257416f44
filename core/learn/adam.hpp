#pragma once

namespace rtg::learn {

/// The weights of a learner, and the moments of its optimiser: arrays of one size. They change.
struct LearnerWeights {
  float* online = nullptr;
  float* target = nullptr;
  float* mean = nullptr;
  float* first_moment = nullptr;   // m, zeros before the first step
  float* second_moment = nullptr;  // v, likewise
};

/// How far a step moves the weights.
struct StepRates {
  long step = 1;          // t, the number of this step, counted from 1
  double learning = 0.0;  // α
  double target = 0.0;    // share of the way to the online weights; 0: none
  double mean = 0.0;      // likewise
};

inline constexpr double kMaxGradientNorm = 10.0;

/// Performs a step of Adam [Kingma and Ba 2015] on the online weights w,
///
///   m ← m + (1 - β₁) (g - m),   v ← v + (1 - β₂) (g² - v),
///   w ← w - α m / (1 - β₁ᵗ) / (√(v / (1 - β₂ᵗ)) + ε),   β₁ = 0.9, β₂ = 0.999, ε = 1e-8,
///
/// where g is `gradient` [count], shortened to kMaxGradientNorm if it is longer. Then moves the
/// weights of the target network and of the mean network towards w.
///
/// With PyTorch's operations for the same, each of which passes over all weights, a whole gradient
/// step takes 1.1 times as long.
void descend(const float* gradient, int count, const LearnerWeights& weights,
             const StepRates& rates);

}  // namespace rtg::learn
