#include "core/energy/local_point.hpp"

#include <gtest/gtest.h>

#include "tests/support/contact_samples.hpp"
#include "tests/support/differences.hpp"

namespace rtg {
namespace {

using testing::derivative_error;
using testing::dual;
using testing::dual_part;
using testing::poses_with_point_at;
using testing::test_directions;

const Vector2d kVertex(0.5, -0.3);

VectorXd point(const VectorXd& q) { return LocalPoint<double>(kVertex, q).x; }

TEST(LocalPoint, IsTheVertexInTheOtherBodysFrame) {
  Rng rng(1);
  for (int trial = 0; trial < 10; ++trial) {
    const Vector2d expected(rng.uniform(-1, 1), rng.uniform(-1, 1));
    const Vec6<double> q = poses_with_point_at(kVertex, expected, rng);
    EXPECT_LT((LocalPoint<double>(kVertex, q).x - expected).norm(), 1e-15);
  }
}

TEST(LocalPoint, JacobianMatchesDifferences) {
  Rng rng(2);
  for (int trial = 0; trial < 10; ++trial) {
    const Vec6<double> q = poses_with_point_at(kVertex, {0.6, 0.1}, rng);
    const LocalPoint<double> x(kVertex, q);
    EXPECT_LT(derivative_error(point, x.jacobian, q, test_directions(x.jacobian.row(0), rng)),
              1e-9);
  }
}

TEST(LocalPoint, HessianMatchesDifferencesOfTheJacobian) {
  Rng rng(3);
  for (int trial = 0; trial < 10; ++trial) {
    const Vec6<double> q = poses_with_point_at(kVertex, {0.6, 0.1}, rng);
    const Vector2d w(rng.uniform(-1, 1), rng.uniform(-1, 1));
    const auto gradient = [&w](const VectorXd& at) -> VectorXd {
      return LocalPoint<double>(kVertex, at).jacobian.transpose() * w;
    };
    EXPECT_LT(derivative_error(gradient, LocalPoint<double>(kVertex, q).hessian(w), q,
                               test_directions(gradient(q), rng)),
              1e-9);
  }
}

TEST(LocalPoint, DoesNotChangeWithARigidMotionOfTheScene) {
  Rng rng(4);
  const Vec6<double> q = poses_with_point_at(kVertex, {0.6, 0.1}, rng);
  const LocalPoint<double> moved(kVertex, testing::rigidly_moved(q, 2.1, {3.0, -5.0}));
  EXPECT_LT((moved.x - LocalPoint<double>(kVertex, q).x).norm(), 1e-14);
}

TEST(LocalPoint, DualPartsAreDerivativesAlongTheSeed) {
  Rng rng(5);
  const Vec6<double> q = poses_with_point_at(kVertex, {0.6, 0.1}, rng);
  for (const VectorXd& y : test_directions(Vec6<double>::Ones(), rng)) {
    const LocalPoint<Dual> d(kVertex, dual<6>(q, y));
    const LocalPoint<double> up(kVertex, q + 1e-6 * y), down(kVertex, q - 1e-6 * y);
    EXPECT_LT((dual_part<2, 1>(d.x) - (up.x - down.x) / 2e-6).norm(), 1e-9);
    EXPECT_LT((dual_part<2, 6>(d.jacobian) - (up.jacobian - down.jacobian) / 2e-6).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace rtg
