#include "core/math/block_ldl.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/math/block_tridiagonal.hpp"
#include "tests/support/random_stages.hpp"

namespace rtg {
namespace {

/// A random symmetric matrix of M bodies coupled over `reach` places.
BlockMatrix<double> random_matrix(int M, int reach, double diagonal, Rng& rng) {
  BlockMatrix<double> A(M);
  testing::RandomBlocks{0.5, diagonal, true}.fill(A, 0, reach, rng);
  return A;
}

MatrixXd dense(const BlockMatrix<double>& A) {
  MatrixXd out = MatrixXd::Zero(3 * A.M, 3 * A.M);
  for (int i = 0; i < A.M; ++i)
    for (int j = 0; j <= i; ++j) {
      if (!A.has(i, j)) continue;
      out.block<3, 3>(3 * i, 3 * j) = A.at(i, j);
      out.block<3, 3>(3 * j, 3 * i) = A.at(i, j).transpose();
    }
  return out;
}

TEST(BlockLdl, SolvesSparseAndDenseSystems) {
  Rng rng(1);
  for (const int M : {1, 2, 5, 8})
    for (const int reach : {0, 1, 3, 7}) {
      const BlockMatrix<double> A = random_matrix(M, reach, 3.0, rng);
      BlockLdl<double> factor(M);
      factor.factorize(A);
      EXPECT_TRUE(factor.regular());
      VectorXd x = VectorXd::NullaryExpr(3 * M, [&] { return rng.uniform(-1.0, 1.0); });
      const VectorXd r = x;
      BlockColumn<double> blocks(static_cast<std::size_t>(M));
      for (int i = 0; i < M; ++i) blocks[static_cast<std::size_t>(i)] = r.segment<3>(3 * i);
      factor.solve(blocks.data());
      for (int i = 0; i < M; ++i) x.segment<3>(3 * i) = blocks[static_cast<std::size_t>(i)];
      EXPECT_LT((dense(A) * x - r).norm(), 1e-12) << M << ", " << reach;
    }
}

/// A row of blocks.
MatrixXd dense(const std::vector<Block<double>>& row) {
  MatrixXd out(3, 3 * static_cast<Eigen::Index>(row.size()));
  for (std::size_t i = 0; i < row.size(); ++i)
    out.middleCols<3>(3 * static_cast<Eigen::Index>(i)) = row[i];
  return out;
}

TEST(BlockLdl, SolvesForRowsOfBlocks) {
  Rng rng(2);
  constexpr int M = 5;
  const BlockMatrix<double> A = random_matrix(M, 2, 3.0, rng);
  BlockLdl<double> factor(M);
  factor.factorize(A);
  for (int first = 0; first <= M; ++first) {
    std::vector<Block<double>> row(M, Block<double>::Zero());
    for (int i = first; i < M; ++i)
      row[static_cast<std::size_t>(i)] =
          Block<double>::NullaryExpr([&] { return rng.uniform(-1.0, 1.0); });
    const MatrixXd given = dense(row);
    std::vector<Block<double>> rest = row;
    const auto solve = [&](std::vector<Block<double>>& r, int zeros, int from) {
      const std::vector<Block<double>> right = r;
      factor.solve_row(
          [&](int i) { return RegisterSum<Block<double>>(right[static_cast<std::size_t>(i)]); },
          zeros, from, r.data());
    };
    solve(row, first, 0);
    EXPECT_LT((dense(row) * dense(A) - given).norm(), 1e-12) << first;
    solve(rest, 0, first);  // what is zero may as well be read
    for (int i = first; i < M; ++i)
      EXPECT_LT((rest[static_cast<std::size_t>(i)] - row[static_cast<std::size_t>(i)]).norm(),
                1e-15);
  }
}

/// Expects A's definiteness to be told, and returns whether A is positive definite.
bool definiteness_told(const BlockMatrix<double>& A) {
  const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(dense(A)).eigenvalues().minCoeff();
  EXPECT_EQ(BlockLdl<double>(A.M).factorize(A), least > 0.0) << least;
  return least > 0.0;
}

TEST(BlockLdl, TellsWhetherAMatrixIsPositiveDefinite) {
  Rng rng(3);
  int positive = 0;
  for (int trial = 0; trial < 100; ++trial)
    positive += definiteness_told(random_matrix(4, 2, rng.uniform(0.5, 3.0), rng));
  EXPECT_GT(positive, 10);
  EXPECT_LT(positive, 90);
}

// Whatever the number of negative eigenvalues, and in whichever block: also an even number, which
// leaves determinants positive.
TEST(BlockLdl, TellsItWhereSignsOfTheDiagonalAreMixed) {
  Rng rng(4);
  int positive = 0;
  for (int trial = 0; trial < 200; ++trial) {
    BlockMatrix<double> A = random_matrix(1 + trial % 3, 2, 0.0, rng);
    for (int i = 0; i < A.M; ++i)
      for (int m = 0; m < 3; ++m) A.at(i, i)(m, m) += 2.0 * A.M * (rng.below(8) == 0 ? -1.0 : 1.0);
    positive += definiteness_told(A);
  }
  EXPECT_GT(positive, 50);
  EXPECT_LT(positive, 150);
}

TEST(BlockLdl, SingularPivotsAreReported) {
  Rng rng(4);
  BlockMatrix<double> A = random_matrix(3, 1, 3.0, rng);
  A.at(0, 0).row(1).setZero();
  A.at(0, 0).col(1).setZero();
  BlockLdl<double> factor(3);
  factor.factorize(A);
  EXPECT_FALSE(factor.regular());
}

TEST(BlockLdl, WhetherAPivotIsSingularDoesNotDependOnItsUnit) {
  Rng rng(5);
  const BlockMatrix<double> regular = random_matrix(3, 1, 3.0, rng);
  BlockMatrix<double> singular = regular;
  singular.at(0, 0) << 1.0, 1.0, 0.0, 1.0, 1.0 + 1e-15, 0.0, 0.0, 0.0, 1.0;
  for (const double unit : {1e-12, 1e-6, 1e6, 1e12}) {
    const auto is_regular = [&](BlockMatrix<double> A) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j)
          if (A.has(i, j)) A.at(i, j) *= unit;
      BlockLdl<double> factor(3);
      factor.factorize(A);
      return factor.regular();
    };
    EXPECT_TRUE(is_regular(regular)) << unit;
    EXPECT_FALSE(is_regular(singular)) << unit;
  }
}

// A stiff contact: D = s n nᵀ + I, whose inverse is I - s/(1 + s) n nᵀ. Its determinant s is less
// than the rounding errors of its products, s³ ε, from s = 1e8 on.
TEST(SymmetricInverse, IsAccurateForStiffBlocks) {
  const Vec3<double> n = Vec3<double>(1.0, -2.0, 2.0) / 3.0;
  for (const double s : {1e2, 1e6, 1e10, 1e12}) {
    const Block<double> A = s * n * n.transpose() + Block<double>::Identity();
    const SymmetricInverse<double> of(A);
    EXPECT_TRUE(of.positive && of.regular) << s;
    const Block<double> expected = Block<double>::Identity() - s / (1.0 + s) * n * n.transpose();
    EXPECT_LT((of.inverse - expected).norm(), 1e-14 * s) << s;
  }
}

TEST(SymmetricInverse, OfAnIndefiniteBlockComesFromCofactors) {
  Block<double> A;
  A << 0.0, 2.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 4.0;
  const SymmetricInverse<double> of(A);
  EXPECT_TRUE(!of.positive && of.regular);
  EXPECT_EQ(Block<double>(of.inverse * A), Block<double>(Block<double>::Identity()));
  A(1, 0) = 0.0;
  const SymmetricInverse<double> none(A);
  EXPECT_FALSE(none.positive || none.regular);
}

TEST(SymmetricInverse, LanesOfEachKindHaveTheInverseThatTheyHaveAlone) {
  constexpr double kDiagonals[][3] = {{2.0, 3.0, 4.0}, {-2.0, 3.0, 4.0}, {0.0, 3.0, 4.0}};
  const auto block = [&](int l) {
    const double* d = kDiagonals[l % 3];
    Block<double> A;
    A << d[0], 0.0, 0.0, 0.0, d[1], 0.5, 0.0, 0.5, d[2];
    return A;
  };
  Block<Lanes> all;
  for (int l = 0; l < kWidth<Lanes>; ++l)
    for (int k = 0; k < 9; ++k) set_lane(all.data()[k], l, block(l).data()[k]);
  const SymmetricInverse<Lanes> together(all);
  for (int l = 0; l < kWidth<Lanes>; ++l) {
    const SymmetricInverse<double> alone(block(l));
    EXPECT_EQ(lane(together.positive, l), alone.positive) << l;
    EXPECT_EQ(lane(together.positive, l), l % 3 == 0);
    EXPECT_EQ(lane(together.regular, l), alone.regular) << l;
    EXPECT_EQ(lane(together.regular, l), l % 3 != 2);
    for (int k = 0; k < 9 && alone.regular; ++k)
      EXPECT_NEAR(lane(together.inverse.data()[k], l), alone.inverse.data()[k], 1e-15) << l;
  }
}

}  // namespace
}  // namespace rtg
