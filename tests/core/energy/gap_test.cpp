#include "core/energy/gap.hpp"

#include <gtest/gtest.h>

#include "tests/support/contact_samples.hpp"
#include "tests/support/differences.hpp"

namespace rtg {
namespace {

using testing::derivative_error;
using testing::dual;
using testing::dual_part;
using testing::kAlpha;
using testing::points_near_a_box;
using testing::poses_with_point_at;
using testing::test_directions;

constexpr double kSkin = 0.004;
const Vector2d kVertex(0.5, -0.3);
const HalfPlanes kBox = half_planes(box(1.2, 1.2));

Gap<double> gap_at(const VectorXd& q) {
  return gap(kBox, kAlpha, kSkin, LocalPoint<double>(kVertex, Vec6<double>(q)));
}
VectorXd value_at(const VectorXd& q) { return VectorXd::Constant(1, gap_at(q).value); }
VectorXd gradient_at(const VectorXd& q) { return gap_at(q).gradient; }

TEST(Gap, IsTheDistanceToTheFaceLessTheSkin) {
  Rng rng(1);
  const Vec6<double> q = poses_with_point_at(kVertex, {0.65, 0.1}, rng);
  EXPECT_NEAR(gap_at(q).value, 0.05 - kSkin, 1e-11);  // corners 0.5 away: e^(-25)/α
}

TEST(Gap, GradientMatchesDifferences) {
  Rng rng(2);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6<double> q = poses_with_point_at(kVertex, x, rng);
    const VectorXd g = gradient_at(q);
    EXPECT_LT(derivative_error(value_at, g.transpose(), q, test_directions(g, rng)), 1e-8)
        << x.transpose();
  }
}

TEST(Gap, HessianMatchesDifferencesOfTheGradient) {
  Rng rng(3);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6<double> q = poses_with_point_at(kVertex, x, rng);
    EXPECT_LT(
        derivative_error(gradient_at, gap_at(q).hessian, q, test_directions(gradient_at(q), rng)),
        1e-7)
        << x.transpose();
  }
}

TEST(Gap, DualPartsAreDerivativesAlongTheSeed) {
  Rng rng(4);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6<double> q = poses_with_point_at(kVertex, x, rng);
    for (const VectorXd& y : test_directions(gradient_at(q), rng)) {
      const auto d = gap(kBox, kAlpha, kSkin, LocalPoint<Dual>(kVertex, dual<6>(q, y)));
      const double t = 1e-6;
      const Gap<double> up = gap_at(q + t * y), down = gap_at(q - t * y);
      EXPECT_NEAR(d.value.d, (up.value - down.value) / (2.0 * t), 1e-8);
      EXPECT_LT((dual_part<6, 1>(d.gradient) - (up.gradient - down.gradient) / (2.0 * t)).norm(),
                1e-7);
      const MatrixXd difference = (up.hessian - down.hessian) / (2.0 * t);  // grows with α²
      EXPECT_LT((dual_part<6, 6>(d.hessian) - difference).norm(), 1e-6 * (1.0 + difference.norm()));
    }
  }
}

TEST(Gap, DoesNotChangeWithARigidMotionOfTheScene) {
  Rng rng(5);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6<double> q = poses_with_point_at(kVertex, x, rng);
    const Vec6<double> moved = testing::rigidly_moved(q, -1.3, {2.0, 4.0});
    EXPECT_NEAR(gap_at(moved).value, gap_at(q).value, 1e-14);
  }
}

TEST(Gap, NormalForcesAreActionAndReaction) {
  Rng rng(6);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec6<double> q = poses_with_point_at(kVertex, x, rng);
    EXPECT_LT(testing::net_wrench(gradient_at(q), q).norm(), 1e-14);
  }
}

TEST(Gap, ShorterFormsGiveTheSameNumbers) {
  Rng rng(7);
  for (const Vector2d& x : points_near_a_box()) {
    const LocalPoint<double> point(kVertex, poses_with_point_at(kVertex, x, rng));
    const Gap<double> g = gap(kBox, kAlpha, kSkin, point);
    const GapSlope<double> slope = gap_slope(kBox, kAlpha, kSkin, point);
    EXPECT_EQ(gap_value(kBox, kAlpha, kSkin, point), g.value);
    EXPECT_EQ(slope.value, g.value);
    EXPECT_EQ(slope.gradient, g.gradient);
  }
}

}  // namespace
}  // namespace rtg
