#include "core/reverse/problem/speed_penalty.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

constexpr double kWeight = 0.3, kStride = 0.2;
const energy::Damping<double> kBody{2.0, 0.5, false};

SpeedPenalty<double> at(const Vector3d& displacement) {
  return {kWeight, kStride, kBody, displacement};
}

TEST(SpeedPenalty, IsTheCubeOfTheSquaredSpeed) {
  EXPECT_EQ(at(Vector3d::Zero()).value, 0.0);
  EXPECT_NEAR(at({kStride, 0, 0}).value, kWeight / 8.0, 1e-15);
  EXPECT_NEAR(at({0, 2 * kStride, 0}).value, 8.0 * kWeight, 1e-14);
  EXPECT_NEAR(at({0, 0, 2 * kStride}).value, kWeight / 8.0, 1e-15) << "a radius of gyration of ½ m";
}

TEST(SpeedPenalty, DerivativesMatchDifferences) {
  Rng rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3d displacement = testing::noise(3, 0.3, rng), along = testing::noise(3, 1.0, rng);
    const double t = 1e-5;
    const SpeedPenalty<double> here = at(displacement), ahead = at(displacement + t * along),
                               behind = at(displacement - t * along);
    EXPECT_NEAR((ahead.value - behind.value) / (2.0 * t), here.gradient.dot(along), 1e-6);
    EXPECT_LT(((ahead.gradient - behind.gradient) / (2.0 * t) - here.hessian * along).norm(), 1e-5);
  }
}

TEST(SpeedPenalty, IsConvex) {
  Rng rng(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Matrix3d H = at(testing::noise(3, 0.5, rng)).hessian;
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(H).eigenvalues().minCoeff(), -1e-12);
  }
}

}  // namespace
}  // namespace rtg::reverse
