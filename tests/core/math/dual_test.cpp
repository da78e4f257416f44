#include "core/math/dual.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace rtg {
namespace {

/// Every operation of Dual in one expression, for S = double or Dual.
template <class S>
S expression(const S& x) {
  using std::exp, std::log, std::sin, std::cos, std::sqrt;
  S y = exp(-x / S(3.0)) * sin(x) - cos(x * x);
  y += log(S(2.0) + x * x);
  y *= sqrt(S(1.0) + x * x);
  y -= x;
  y /= S(3.0) + cos(x);
  return y;
}

TEST(Dual, DerivativeOfAnExpressionMatchesDifferences) {
  const double t = 1e-6;
  for (const double x : {-2.1, -0.3, 0.0, 0.8, 4.0}) {
    const Dual y = expression(Dual(x, 1.0));
    EXPECT_DOUBLE_EQ(y.v, expression(x));
    EXPECT_NEAR(y.d, (expression(x + t) - expression(x - t)) / (2.0 * t), 1e-8) << x;
  }
}

TEST(Dual, FunctionsHaveTheirTextbookDerivatives) {
  const Dual x(0.7, 2.0);
  EXPECT_DOUBLE_EQ(exp(x).d, 2.0 * std::exp(0.7));
  EXPECT_DOUBLE_EQ(log(x).d, 2.0 / 0.7);
  EXPECT_DOUBLE_EQ(sin(x).d, 2.0 * std::cos(0.7));
  EXPECT_DOUBLE_EQ(cos(x).d, -2.0 * std::sin(0.7));
  EXPECT_DOUBLE_EQ(sqrt(x).d, 1.0 / std::sqrt(0.7));
}

TEST(Dual, OperationsObeyTheRulesOfDifferentiation) {
  const Dual a(3.0, 0.5), b(-2.0, 4.0);
  EXPECT_DOUBLE_EQ((a + b).d, 4.5);
  EXPECT_DOUBLE_EQ((a - b).d, -3.5);
  EXPECT_DOUBLE_EQ((a * b).d, 0.5 * -2.0 + 3.0 * 4.0);
  EXPECT_DOUBLE_EQ((a / b).d, (0.5 * -2.0 - 3.0 * 4.0) / 4.0);
  EXPECT_DOUBLE_EQ((-a).d, -0.5);
  EXPECT_DOUBLE_EQ((a * Dual(2.0)).d, 1.0);  // a constant has no derivative
}

TEST(Dual, ComparisonsLookAtTheValueAlone) {
  EXPECT_TRUE(Dual(1.0, 9.0) < Dual(2.0, -9.0));
  EXPECT_TRUE(Dual(2.0, -9.0) > Dual(1.0, 9.0));
  EXPECT_FALSE(Dual(1.0, 0.0) < Dual(1.0, 1.0));
  EXPECT_EQ(value_of(Dual(4.0, 5.0)), 4.0);
  EXPECT_EQ(value_of(4.0), 4.0);
}

// d/dε of (M + εN) x along both at once, the product rule of matrices.
TEST(Dual, IsAScalarOfEigen) {
  Eigen::Matrix2d M, N;
  M << 1, 2, 3, 4;
  N << -1, 0.5, 2, 7;
  const Eigen::Vector2d x(0.3, -0.8), y(2, 1);
  Eigen::Matrix<Dual, 2, 2> D;
  Eigen::Matrix<Dual, 2, 1> d;
  for (int i = 0; i < 2; ++i) {
    d[i] = Dual(x[i], y[i]);
    for (int j = 0; j < 2; ++j) D(i, j) = Dual(M(i, j), N(i, j));
  }
  const Eigen::Matrix<Dual, 2, 1> product = D * d;
  const Eigen::Vector2d expected = N * x + M * y;
  for (int i = 0; i < 2; ++i) {
    EXPECT_DOUBLE_EQ(product[i].v, (M * x)[i]);
    EXPECT_DOUBLE_EQ(product[i].d, expected[i]);
  }
}

}  // namespace
}  // namespace rtg
