#include "core/learn/adam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace rtg::learn {
namespace {

using Numbers = std::vector<float>;

constexpr int kCount = 5000;  // more than are computed together

Numbers random_numbers(std::mt19937& random, float size) {
  std::normal_distribution<float> normal(0.0f, size);
  Numbers out(kCount);
  for (float& x : out) x = normal(random);
  return out;
}

/// Arrays like LearnerWeights', in the precision of Real.
template <class Real>
struct State {
  std::vector<Real> online, target, mean, m, v;
};

/// Steps by the formulas of the header, weight by weight.
void plain_step(State<double>& s, const Numbers& gradient, const StepRates& rates) {
  double square = 0.0;
  for (const float g : gradient) square += static_cast<double>(g) * g;
  const double scale = std::min(1.0, kMaxGradientNorm / std::sqrt(square));
  const double t = static_cast<double>(rates.step);
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    const double g = scale * gradient[k];
    s.m[k] = 0.9 * s.m[k] + 0.1 * g;
    s.v[k] = 0.999 * s.v[k] + 0.001 * g * g;
    const double m = s.m[k] / (1.0 - std::pow(0.9, t)), v = s.v[k] / (1.0 - std::pow(0.999, t));
    s.online[k] -= rates.learning * m / (std::sqrt(v) + 1e-8);
    s.target[k] += rates.target * (s.online[k] - s.target[k]);
    s.mean[k] += rates.mean * (s.online[k] - s.mean[k]);
  }
}

// Gradients of norm 7 and of norm 700, which is cut.
TEST(Adam, StepsAreThoseOfAPlainLoop) {
  std::mt19937 random(5);
  State<float> ours{random_numbers(random, 1.0f), random_numbers(random, 1.0f),
                    random_numbers(random, 1.0f), Numbers(kCount), Numbers(kCount)};
  const auto wide = [](const Numbers& x) { return std::vector<double>(x.begin(), x.end()); };
  State<double> plain{wide(ours.online), wide(ours.target), wide(ours.mean), wide(ours.m),
                      wide(ours.v)};
  const Numbers start = ours.online;
  for (long step = 1; step <= 20; ++step) {
    const StepRates rates{step, 1e-2, step % 2 == 0 ? 0.25 : 0.0, 0.5};
    const Numbers gradient = random_numbers(random, step % 3 == 0 ? 10.0f : 0.1f);
    descend(
        gradient.data(), kCount,
        {ours.online.data(), ours.target.data(), ours.mean.data(), ours.m.data(), ours.v.data()},
        rates);
    plain_step(plain, gradient, rates);
    for (std::size_t k = 0; k < kCount; ++k) {
      ASSERT_NEAR(ours.online[k], plain.online[k], 1e-5) << step;
      ASSERT_NEAR(ours.target[k], plain.target[k], 1e-5) << step;
      ASSERT_NEAR(ours.mean[k], plain.mean[k], 1e-5) << step;
    }
  }
  double moved = 0.0;
  for (std::size_t k = 0; k < kCount; ++k) moved += std::abs(ours.online[k] - start[k]) / kCount;
  EXPECT_GT(moved, 0.02);
}

}  // namespace
}  // namespace rtg::learn
