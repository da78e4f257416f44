#include "core/math/block_tridiagonal.hpp"

#include <gtest/gtest.h>

namespace rtg {
namespace {

BlockTridiagonal two_by_one_by_one() {
  BlockTridiagonal K;
  K.A = {MatrixXd{{1, 2}, {2, 3}}, MatrixXd{{4}}, MatrixXd{{5}}};
  K.B = {MatrixXd(), MatrixXd{{6, 7}}, MatrixXd{{8}}};
  return K;
}

TEST(BlockTridiagonal, DenseHasTheBlocksInTheirPlaces) {
  const MatrixXd expected{{1, 2, 6, 0}, {2, 3, 7, 0}, {6, 7, 4, 8}, {0, 0, 8, 5}};
  EXPECT_EQ(two_by_one_by_one().order(), 4);
  EXPECT_EQ(two_by_one_by_one().dense(), expected);
}

TEST(BlockTridiagonal, SparseIsTheDenseMatrixWithoutItsZeros) {
  BlockTridiagonal K = two_by_one_by_one();
  K.B[1](0, 1) = 0.0;
  EXPECT_EQ(MatrixXd(sparse(K)), K.dense());
  EXPECT_EQ(sparse(K).nonZeros(), 10);
}

TEST(BlockTridiagonal, ProductIsThatOfTheDenseMatrix) {
  const BlockTridiagonal K = two_by_one_by_one();
  const VectorXd x{{1, -2, 3, -4}};
  EXPECT_EQ(joined(product(K, split_like(K, x))), K.dense() * x);
}

TEST(BlockTridiagonal, SplitVectorsHaveTheBlocksSizesAndJoinAgain) {
  const BlockTridiagonal K = two_by_one_by_one();
  const VectorXd x{{1, 2, 3, 4}};
  const BlockVector parts = split_like(K, x);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0], (VectorXd{{1, 2}}));
  EXPECT_EQ(parts[1], (VectorXd{{3}}));
  EXPECT_EQ(parts[2], (VectorXd{{4}}));
  EXPECT_EQ(joined(parts), x);
  EXPECT_EQ(joined({}).size(), 0);
}

}  // namespace
}  // namespace rtg
