#include "core/learn/adam.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace rtg::learn {
namespace {

using Array = Eigen::Map<Eigen::ArrayXf>;
using Eigen::Index;

constexpr double kBeta1 = 0.9, kBeta2 = 0.999;
constexpr float kEpsilon = 1e-8f;
constexpr Index kTogether = 2048;  // weights whose numbers stay in the cache

}  // namespace

void descend(const float* gradient, int count, const LearnerWeights& weights,
             const StepRates& rates) {
  const Eigen::Map<const Eigen::VectorXf> whole(gradient, count);
  const double norm = whole.norm(), t = static_cast<double>(rates.step);
  const auto scale = static_cast<float>(std::min(1.0, kMaxGradientNorm / (norm + 1e-6)));
  const double first = 1.0 - std::pow(kBeta1, t), second = 1.0 - std::pow(kBeta2, t);
  const auto rate = static_cast<float>(rates.learning / first);
  const auto root = static_cast<float>(1.0 / std::sqrt(second));
  for (Index begin = 0; begin < count; begin += kTogether) {
    const Index size = std::min(kTogether, count - begin);
    const auto part = [&](float* array) { return Array(array + begin, size); };
    const auto g = whole.segment(begin, size).array() * scale;
    Array w = part(weights.online), m = part(weights.first_moment);
    Array v = part(weights.second_moment), target = part(weights.target), mean = part(weights.mean);
    m += static_cast<float>(1.0 - kBeta1) * (g - m);
    v += static_cast<float>(1.0 - kBeta2) * (g.square() - v);
    w -= rate * m / (v.sqrt() * root + kEpsilon);
    // At a rate of 1 these are w, bit for bit.
    if (rates.target > 0.0) target = w + static_cast<float>(1.0 - rates.target) * (target - w);
    mean = w + static_cast<float>(1.0 - rates.mean) * (mean - w);
  }
}

}  // namespace rtg::learn
