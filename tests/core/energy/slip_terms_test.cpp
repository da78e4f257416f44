#include "core/energy/slip_terms.hpp"

#include <gtest/gtest.h>

#include "tests/support/contact_samples.hpp"
#include "tests/support/differences.hpp"

namespace rtg::energy {
namespace {

using testing::derivative_error;
using testing::frame_of;
using testing::kAlpha;
using testing::kBox;
using testing::kVertex;
using testing::points_near_a_box;
using testing::poses_with_point_at;
using testing::pushing;
using testing::test_directions;
using testing::Vec6;
using Vec12 = Eigen::Matrix<double, 12, 1>;

constexpr double kSlip = 0.025, kRadius = 0.3;

/// Friction at z = (q₊, q) [12].
struct At {
  PairFrame<double> ahead, here;
  ContactPoint<double> next, now;
  SignedDistance<double> d;
  SlipTerms<double> terms;

  explicit At(const VectorXd& z)
      : ahead(frame_of(z.head(6))),
        here(frame_of(z.tail(6))),
        next(kVertex, ahead, kRadius),
        now(kVertex, here, kRadius),
        d(signed_distance(kBox, kAlpha, now.x)),
        terms(d.gradient, next, now.x, now.roll, kSlip) {}
  double value() const { return terms.value(kSlip); }
  Vec6 force() const { return pushing(ahead).transpose() * terms.gradient(); }
  /// Rates along y of the pose after.
  SlipRates<double> rates(const VectorXd& y) const {
    const Mat2<double> D = d.hessian();
    return {terms, {d, D, next, now}, terms.hessian(next), ahead.pushed(y.data(), y.data() + 3)};
  }
};

VectorXd value_at(const VectorXd& z) { return VectorXd::Constant(1, At(z).value()); }

/// Poses with the vertex at x before the sub-step, and moved at random by ± `size` over it.
VectorXd moved_by(double size, const Vector2d& x, Rng& rng) {
  Vec12 z;
  z.tail<6>() = poses_with_point_at(kVertex, x, rng);
  for (int m = 0; m < 6; ++m) z[m] = z[6 + m] + rng.uniform(-size, size);
  return z;
}

/// Poses of a vertex that slides by u along the face x = 0.6 of a fixed box.
VectorXd sliding_by(double u) {
  Rng rng(9);
  Vec12 z;
  z.tail<6>() = poses_with_point_at(kVertex, {0.61, -0.1}, rng);
  z.head<6>() = z.tail<6>();
  z.head<2>() += rotate(z[11], {0.0, u});
  return z;
}

/// Returns z = (y, 0): y of the poses after, nothing of those before.
VectorXd ahead_alone(const VectorXd& y) {
  Vec12 z = Vec12::Zero();
  z.head<6>() = y;
  return z;
}

// Sticking (displacements well below ε), at the transition and sliding.
constexpr double kSizes[] = {1e-3, 0.02, 0.3};

/// Calls check(z) for samples of all kinds.
template <class Check>
void for_samples(std::uint64_t seed, Check&& check) {
  Rng rng(seed);
  for (const Vector2d& x : points_near_a_box())
    for (const double size : kSizes) check(moved_by(size, x, rng), rng);
}

TEST(SlipTerms, GradientMatchesDifferences) {
  for_samples(1, [](const VectorXd& z, Rng& rng) {
    const VectorXd g = At(z).force();
    for (const VectorXd& y : test_directions(g, rng))
      EXPECT_NEAR(testing::central_difference(value_at, z, ahead_alone(y))[0], g.dot(y), 1e-7);
  });
}

// Second differences next to a rounded corner grow with α³ and 1/ε², hence the wider tolerance.
TEST(SlipTerms, HessianAndCrossTermsMatchDifferencesOfTheGradient) {
  for_samples(2, [](const VectorXd& z, Rng& rng) {
    const At at(z);
    const auto V = pushing(at.ahead);
    MatrixXd J(6, 12);
    J << V.transpose() * at.terms.hessian(at.next) * V,
        V.transpose() * at.rates(VectorXd::Zero(6)).cross * pushing(at.here);
    const auto force = [](const VectorXd& x) -> VectorXd { return At(x).force(); };
    EXPECT_LT(derivative_error(force, J, z, test_directions(VectorXd::Ones(12), rng)), 1e-6);
  });
}

/// y·∂φ/∂q₊, a function of both poses.
VectorXd power(const VectorXd& z, const VectorXd& y) {
  return VectorXd::Constant(1, y.dot(At(z).force()));
}

// y·∇₊φ is a function of z; its gradient is (next, now), its Hessian the rates of the Hessian.
TEST(SlipTerms, RatesAreDerivativesAlongTheMotion) {
  for_samples(3, [](const VectorXd& z, Rng& rng) {
    const VectorXd y = test_directions(VectorXd::Ones(6), rng)[0];
    const auto gradient = [&y](const VectorXd& x) -> VectorXd {
      const At at(x);
      const SlipRates<double> rates = at.rates(y);
      Vec12 g;
      g.head<6>() = pushing(at.ahead).transpose() * rates.next;
      g.tail<6>() = pushing(at.here).transpose() * rates.now;
      return g;
    };
    const auto function = [&y](const VectorXd& x) { return power(x, y); };
    const VectorXd g = gradient(z);
    EXPECT_LT(derivative_error(function, g.transpose(), z, test_directions(g, rng)), 1e-6);
    const At at(z);
    const SlipRates<double> rates = at.rates(y);
    const auto V = pushing(at.ahead), W = pushing(at.here);
    MatrixXd H(12, 12);
    H << V.transpose() * rates.next_next * V, V.transpose() * rates.next_now * W,
        W.transpose() * rates.next_now.transpose() * V, W.transpose() * rates.now_now * W;
    EXPECT_LT(derivative_error(gradient, H, z, test_directions(g, rng)), 1e-5);
  });
}

TEST(SlipTerms, DoNotChangeWithARigidMotionOfTheScene) {
  for_samples(4, [](const VectorXd& z, Rng&) {
    Vec12 moved;
    moved.head<6>() = testing::rigidly_moved(z.head(6), 0.7, {1.0, -2.0});
    moved.tail<6>() = testing::rigidly_moved(z.tail(6), 0.7, {1.0, -2.0});
    EXPECT_NEAR(At(moved).value(), At(z).value(), 1e-14);
  });
}

TEST(SlipTerms, ForcesAreActionAndReaction) {
  for_samples(5, [](const VectorXd& z, Rng&) {
    EXPECT_LT(testing::net_wrench(At(z).force(), z.head(6)).norm(), 1e-14);
  });
}

// μ_f λ |∇d|, here for unit μ_f λ, times u/√(u² + ε²).
TEST(SlipTerms, ForceTendsToCoulombsAgainstTheSlip) {
  for (const double u : {0.025, 0.25, -0.5, 25.0}) {
    const VectorXd z = sliding_by(u);
    const Vector2d force = rotate(-z[11], At(z).force().head<2>());
    EXPECT_NEAR(force.y(), u / std::hypot(u, kSlip), 1e-9);  // along the face
    EXPECT_NEAR(force.x(), 0.0, 1e-9);
  }
  EXPECT_NEAR(At(sliding_by(25.0)).force().head<2>().norm(), 1.0, 1e-6);
}

TEST(SlipTerms, CoulombsForceAtARoundedCornerHasTheGradientsLength) {
  Rng rng(6);
  Vec12 z;
  const Vector2d corner(0.601, 0.601);
  z.tail<6>() = poses_with_point_at(kVertex, corner, rng);
  z.head<6>() = z.tail<6>();
  z.head<2>() += rotate(z[11], {-1.0, 1.0});  // across the corner's bisector
  const double length = signed_distance(kBox, kAlpha, corner).gradient.norm();
  EXPECT_NEAR(length, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(At(z).force().head<2>().norm(), length, 1e-3);
}

TEST(SlipTerms, SmallSlipsMeetALinearForce) {
  for (const double u : {1e-4, -1e-3})
    EXPECT_NEAR(At(sliding_by(u)).force().head<2>().norm(), std::abs(u) / kSlip,
                1e-3 * std::abs(u) / kSlip);
}

TEST(SlipTerms, PressingWithoutSlipCostsNothing) {
  VectorXd z = sliding_by(0.0);
  z.head<2>() += rotate(z[11], {-0.005, 0.0});  // towards the face
  EXPECT_NEAR(At(z).value(), 0.0, 1e-12);
  EXPECT_LT(At(z).force().head<2>().norm(), 1e-8);
}

}  // namespace
}  // namespace rtg::energy
