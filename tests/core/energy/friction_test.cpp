#include "core/energy/friction.hpp"

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

constexpr double kSlip = 0.025;
const Vector2d kVertex(0.5, -0.3);
const HalfPlanes kBox = half_planes(box(1.2, 1.2));

/// Friction at z = (q₊, q) [12].
template <class S>
Friction<S> friction_at(const Vec12<S>& z) {
  const LocalPoint<S> next(kVertex, Vec6<S>(z.template head<6>()));
  return friction(kBox, kAlpha, kSlip, next, LocalPoint<S>(kVertex, Vec6<S>(z.template tail<6>())));
}
VectorXd value_at(const VectorXd& z) { return VectorXd::Constant(1, friction_at<double>(z).value); }
VectorXd gradient_at(const VectorXd& z) { return friction_at<double>(z).gradient; }

/// Poses with the vertex at x before the sub-step, and moved at random by ± `size` over it.
Vec12<double> moved_by(double size, const Vector2d& x, Rng& rng) {
  Vec12<double> z;
  z.tail<6>() = poses_with_point_at(kVertex, x, rng);
  for (int m = 0; m < 6; ++m) z[m] = z[6 + m] + rng.uniform(-size, size);
  return z;
}

/// Poses of a vertex that slides by u along the face x = 0.6 of a fixed box.
Vec12<double> sliding_by(double u) {
  Rng rng(9);
  Vec12<double> z;
  z.tail<6>() = poses_with_point_at(kVertex, {0.61, -0.1}, rng);
  z.head<6>() = z.tail<6>();
  z.head<2>() += rotate(z[11], {0.0, u});
  return z;
}

// Sticking (displacements well below ε), at the transition and sliding.
constexpr double kSizes[] = {1e-3, 0.02, 0.3};

TEST(Friction, GradientMatchesDifferences) {
  Rng rng(1);
  for (const Vector2d& x : points_near_a_box())
    for (const double size : kSizes) {
      const Vec12<double> z = moved_by(size, x, rng);
      const VectorXd g = gradient_at(z);
      EXPECT_LT(derivative_error(value_at, g.transpose(), z, test_directions(g, rng)), 1e-7)
          << x.transpose() << ", " << size;
    }
}

// Second differences next to a rounded corner grow with α³ and 1/ε², hence the wider tolerance.
TEST(Friction, HessianMatchesDifferencesOfTheGradient) {
  Rng rng(2);
  for (const Vector2d& x : points_near_a_box())
    for (const double size : kSizes) {
      const Vec12<double> z = moved_by(size, x, rng);
      EXPECT_LT(derivative_error(gradient_at, friction_at<double>(z).hessian, z,
                                 test_directions(gradient_at(z), rng)),
                1e-6)
          << x.transpose() << ", " << size;
    }
}

TEST(Friction, DualPartsAreDerivativesAlongTheSeed) {
  Rng rng(3);
  for (const Vector2d& x : points_near_a_box())
    for (const double size : kSizes) {
      const Vec12<double> z = moved_by(size, x, rng);
      for (const VectorXd& y : test_directions(gradient_at(z), rng)) {
        const Friction<Dual> d = friction_at<Dual>(dual<12>(z, y));
        const double t = 1e-6;
        const Friction<double> up = friction_at<double>(z + t * y),
                               down = friction_at<double>(z - t * y);
        EXPECT_NEAR(d.value.d, (up.value - down.value) / (2.0 * t), 1e-6);
        const Vec12<double> slope = (up.gradient - down.gradient) / (2.0 * t);
        EXPECT_LT((dual_part<12, 1>(d.gradient) - slope).norm(), 1e-6 * (1.0 + slope.norm()));
        const Mat12<double> bend = (up.hessian - down.hessian) / (2.0 * t);
        EXPECT_LT((dual_part<12, 12>(d.hessian) - bend).norm(), 1e-5 * (1.0 + bend.norm()));
      }
    }
}

TEST(Friction, DoesNotChangeWithARigidMotionOfTheScene) {
  Rng rng(4);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec12<double> z = moved_by(0.05, x, rng);
    Vec12<double> moved;
    moved.head<6>() = testing::rigidly_moved(z.head<6>(), 0.7, {1.0, -2.0});
    moved.tail<6>() = testing::rigidly_moved(z.tail<6>(), 0.7, {1.0, -2.0});
    EXPECT_NEAR(friction_at<double>(moved).value, friction_at<double>(z).value, 1e-14);
  }
}

TEST(Friction, ForcesAreActionAndReaction) {
  Rng rng(5);
  for (const Vector2d& x : points_near_a_box()) {
    const Vec12<double> z = moved_by(0.05, x, rng);
    const Vec6<double> force = friction_at<double>(z).gradient.head<6>();
    EXPECT_LT(testing::net_wrench(force, z.head<6>()).norm(), 1e-14);
  }
}

// μ_f λ |∇d|, here for unit μ_f λ, times u/√(u² + ε²).
TEST(Friction, ForceTendsToCoulombsAgainstTheSlip) {
  for (const double u : {0.025, 0.25, -0.5, 25.0}) {
    const Vec12<double> z = sliding_by(u);
    const Vector2d force = rotate(-z[11], friction_at<double>(z).gradient.head<2>());
    EXPECT_NEAR(force.y(), u / std::hypot(u, kSlip), 1e-9);  // along the face
    EXPECT_NEAR(force.x(), 0.0, 1e-9);
  }
  EXPECT_NEAR(friction_at<double>(sliding_by(25.0)).gradient.head<2>().norm(), 1.0, 1e-6);
}

TEST(Friction, CoulombsForceAtARoundedCornerHasTheGradientsLength) {
  Rng rng(6);
  Vec12<double> z;
  const Vector2d corner(0.601, 0.601);
  z.tail<6>() = poses_with_point_at(kVertex, corner, rng);
  z.head<6>() = z.tail<6>();
  z.head<2>() += rotate(z[11], {-1.0, 1.0});  // across the corner's bisector
  const double length = SignedDistance<double>(kBox, kAlpha, corner).gradient.norm();
  EXPECT_NEAR(length, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(friction_at<double>(z).gradient.head<2>().norm(), length, 1e-3);
}

TEST(Friction, SmallSlipsMeetALinearForce) {
  for (const double u : {1e-4, -1e-3})
    EXPECT_NEAR(friction_at<double>(sliding_by(u)).gradient.head<2>().norm(), std::abs(u) / kSlip,
                1e-3 * std::abs(u) / kSlip);
}

TEST(Friction, PressingWithoutSlipCostsNothing) {
  Vec12<double> z = sliding_by(0.0);
  z.head<2>() += rotate(z[11], {-0.005, 0.0});  // towards the face
  EXPECT_NEAR(friction_at<double>(z).value, 0.0, 1e-12);
  EXPECT_LT(friction_at<double>(z).gradient.head<2>().norm(), 1e-8);
}

}  // namespace
}  // namespace rtg
