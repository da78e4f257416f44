#include "core/energy/barrier.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace rtg::energy {
namespace {

const Barrier kBarrier{0.003, 0.15, false}, kPlain{0.003, 0.15, true};
constexpr double kGaps[] = {1e-4, 1e-3, 0.01, 0.05, 0.1, 0.149};

/// ∫ f from a to b by Simpson's rule.
template <class F>
double integral(const F& f, double a, double b) {
  constexpr int kIntervals = 2000;
  const double h = (b - a) / (2 * kIntervals);
  double sum = f(a) + f(b);
  for (int k = 1; k < 2 * kIntervals; ++k) sum += (k % 2 ? 4.0 : 2.0) * f(a + k * h);
  return sum * h / 3.0;
}

TEST(Barrier, ValueIsTheWorkOfTheForceUpToTheRange) {
  for (const double g : {0.01, 0.03, 0.075, 0.14}) {
    const double work = integral([](double x) { return kBarrier.force(x); }, g, kBarrier.range);
    EXPECT_NEAR(kBarrier.value(g), work, 1e-11) << g;
  }
}

TEST(Barrier, ValueAtHalfTheRangeIsTheHandCalculatedOne) {
  // ln 2 - 3/2 + 9/8 - 7/24 at y = 1/2
  EXPECT_NEAR(kBarrier.value(0.075), 0.003 * (std::numbers::ln2 - 2.0 / 3.0), 1e-17);
}

TEST(Barrier, ForceAndItsSlopeMatchDifferences) {
  for (const Barrier& barrier : {kBarrier, kPlain})
    for (const double g : kGaps) {
      const double t = 1e-4 * g;  // error (t/g)²/3 relative
      EXPECT_NEAR(barrier.force(g), -(barrier.value(g + t) - barrier.value(g - t)) / (2.0 * t),
                  1e-8 * barrier.weight / g);
      EXPECT_NEAR(barrier.force_slope(g), (barrier.force(g + t) - barrier.force(g - t)) / (2.0 * t),
                  3e-8 * barrier.weight / (g * g));
    }
}

TEST(Barrier, WindowsDerivativesMatchDifferences) {
  const double t = 1e-6;
  for (const double g : kGaps) {
    const auto up = kBarrier.window(g + t), down = kBarrier.window(g - t), w = kBarrier.window(g);
    EXPECT_NEAR(w.d1, (up.w - down.w) / (2.0 * t), 1e-8);
    EXPECT_NEAR(w.d2, (up.d1 - down.d1) / (2.0 * t), 1e-6);
  }
}

TEST(Barrier, ForceSatisfiesRelaxedComplementarity) {
  for (const double g : kGaps) {
    const double expected = kBarrier.weight * std::pow(1.0 - g / 0.15, 3);
    EXPECT_NEAR(kBarrier.force(g) * g, expected, 1e-12 * expected);
  }
}

// Close to the range b goes like the fourth power of what is left of it, so b and its first three
// derivatives vanish there: each is divided by 2^4, 2^3, 2^2, 2 where the rest is halved.
TEST(Barrier, AtTheStartOfAPushForcesAreThoseOfAWiderGap) {
  const double spare = kBarrier.start_spare();
  EXPECT_NEAR(spare, 3e-4, 1e-12);
  for (const double g : {1e-9, 1e-4, 0.01, 0.149}) {
    const double force = kBarrier.force(g, spare);
    EXPECT_NEAR(force * (g + spare), kBarrier.weight * kBarrier.window(g).w, 1e-15);
    EXPECT_LE(force, 10.0);
  }
  EXPECT_EQ(kPlain.start_spare(), 0.0);
}

TEST(Barrier, IsThreeTimesContinuouslyDifferentiableAtItsRange) {
  const auto third = [](double g) {
    return (kBarrier.force_slope(g + 1e-6) - kBarrier.force_slope(g - 1e-6)) / 2e-6;
  };
  const double far = 0.15 * (1.0 - 2e-3), near = 0.15 * (1.0 - 1e-3);
  EXPECT_NEAR(kBarrier.value(far) / kBarrier.value(near), 16.0, 0.1);
  EXPECT_NEAR(kBarrier.force(far) / kBarrier.force(near), 8.0, 0.05);
  EXPECT_NEAR(kBarrier.force_slope(far) / kBarrier.force_slope(near), 4.0, 0.05);
  EXPECT_NEAR(third(far) / third(near), 2.0, 0.05);
}

TEST(Barrier, VanishesBeyondItsRange) {
  for (const double g : {0.15, 0.2, 10.0}) {
    EXPECT_EQ(kBarrier.value(g), 0.0);
    EXPECT_EQ(kBarrier.force(g), 0.0);
    EXPECT_EQ(kBarrier.force_slope(g), 0.0);
  }
  EXPECT_GT(kBarrier.force(0.1499), 0.0);
}

TEST(Barrier, OverlapIsInfinitelyExpensive) {
  for (const Barrier& barrier : {kBarrier, kPlain})
    for (const double g : {0.0, -1e-12, -1.0}) {
      EXPECT_EQ(barrier.value(g), INFINITY);
    }
}

TEST(Barrier, PlainOneIsThePapersLogarithmAtAnyGap) {
  for (const double g : {1e-3, 0.15, 7.0}) {
    EXPECT_DOUBLE_EQ(kPlain.value(g), -0.003 * std::log(g));
    EXPECT_DOUBLE_EQ(kPlain.force(g), 0.003 / g);
    EXPECT_DOUBLE_EQ(kPlain.force_slope(g), -0.003 / (g * g));
  }
}

}  // namespace
}  // namespace rtg::energy
