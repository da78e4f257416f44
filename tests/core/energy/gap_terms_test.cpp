#include "core/energy/gap_terms.hpp"

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

/// The gap of the vertex to the box at q, with all that is derived of it.
struct At {
  PairFrame<double> frame;
  ContactPoint<double> point;
  SignedDistance<double> d;
  Mat2<double> D;
  GapTerms<double> terms;

  explicit At(const VectorXd& q)
      : frame(frame_of(q)),
        point(kVertex, frame, 0.3),
        d(signed_distance(kBox, kAlpha, point.x)),
        D(d.hessian()),
        terms(d, D, point) {}
  VectorXd gradient() const { return pushing(frame).transpose() * terms.gradient; }
  MatrixXd hessian() const {
    const auto V = pushing(frame);
    return V.transpose() * terms.hessian * V;
  }
};

VectorXd value_at(const VectorXd& q) { return VectorXd::Constant(1, At(q).d.value); }
VectorXd gradient_at(const VectorXd& q) { return At(q).gradient(); }

TEST(ContactPoint, IsTheVertexInTheOtherBodysFrame) {
  Rng rng(1);
  for (int trial = 0; trial < 10; ++trial) {
    const Vector2d expected(rng.uniform(-1, 1), rng.uniform(-1, 1));
    const Vec6 q = poses_with_point_at(kVertex, expected, rng);
    EXPECT_LT((At(q).point.x - expected).norm(), 1e-15);
  }
}

TEST(ContactPoint, RatesAreDerivativesAlongTheMotion) {
  Rng rng(2);
  const Vec6 q = poses_with_point_at(kVertex, {0.6, 0.1}, rng);
  for (const VectorXd& y : test_directions(Vec6::Ones(), rng)) {
    const ContactPoint<double> rate = At(q).point.along(At(q).frame.pushed(y.data(), y.data() + 3));
    const ContactPoint<double> up = At(q + 1e-6 * y).point, down = At(q - 1e-6 * y).point;
    EXPECT_LT((rate.x - (up.x - down.x) / 2e-6).norm(), 1e-9);
    EXPECT_LT((rate.a - (up.a - down.a) / 2e-6).norm(), 1e-9);
    EXPECT_NEAR(rate.roll, (up.roll - down.roll) / 2e-6, 1e-9);
  }
}

TEST(GapTerms, GradientMatchesDifferences) {
  Rng rng(3);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6 q = poses_with_point_at(kVertex, x, rng);
    const VectorXd g = gradient_at(q);
    EXPECT_LT(derivative_error(value_at, g.transpose(), q, test_directions(g, rng)), 1e-8)
        << x.transpose();
  }
}

TEST(GapTerms, HessianMatchesDifferencesOfTheGradient) {
  Rng rng(4);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6 q = poses_with_point_at(kVertex, x, rng);
    EXPECT_LT(
        derivative_error(gradient_at, At(q).hessian(), q, test_directions(gradient_at(q), rng)),
        1e-7)
        << x.transpose();
  }
}

TEST(GapTerms, RatesAreDerivativesAlongTheMotion) {
  Rng rng(5);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6 q = poses_with_point_at(kVertex, x, rng);
    for (const VectorXd& y : test_directions(gradient_at(q), rng)) {
      const At at(q);
      const GapRates<double> rates(at.d, at.D, at.point, at.terms,
                                   at.frame.pushed(y.data(), y.data() + 3));
      const auto V = pushing(at.frame);
      const double t = 1e-6;
      const At up(q + t * y), down(q - t * y);
      EXPECT_LT(
          (V.transpose() * rates.gradient - (up.gradient() - down.gradient()) / (2.0 * t)).norm(),
          1e-7);
      const MatrixXd difference = (up.hessian() - down.hessian()) / (2.0 * t);  // grows with α²
      EXPECT_LT((V.transpose() * rates.hessian * V - difference).norm(),
                1e-6 * (1.0 + difference.norm()));
    }
  }
}

TEST(GapTerms, DoesNotChangeWithARigidMotionOfTheScene) {
  Rng rng(6);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6 q = poses_with_point_at(kVertex, x, rng);
    EXPECT_NEAR(At(testing::rigidly_moved(q, -1.3, {2.0, 4.0})).d.value, At(q).d.value, 1e-14);
  }
}

TEST(GapTerms, NormalForcesAreActionAndReaction) {
  Rng rng(7);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6 q = poses_with_point_at(kVertex, x, rng);
    EXPECT_LT(testing::net_wrench(gradient_at(q), q).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace rtg::energy
