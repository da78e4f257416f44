#include "core/energy/pair_frame.hpp"

#include <gtest/gtest.h>

#include "tests/support/contact_samples.hpp"
#include "tests/support/differences.hpp"

namespace rtg::energy {
namespace {

using testing::frame_of;
using testing::pushing;
using testing::Vec6;

Vec6 some_poses(Rng& rng) {
  return testing::poses_with_point_at(testing::kVertex, {0.6, 0.1}, rng);
}

Mat4<double> some_matrix(Rng& rng) {
  return Mat4<double>::NullaryExpr([&] { return rng.uniform(-1.0, 1.0); });
}

TEST(PairFrame, SeesTheOtherBodysOffsetAndTurn) {
  Rng rng(1);
  const Vec6 q = some_poses(rng);
  const PairFrame<double> frame = frame_of(q);
  EXPECT_LT((frame.offset - rotate(-q[5], q.head<2>() - q.segment<2>(3))).norm(), 1e-15);
  EXPECT_NEAR(frame.across.c, std::cos(q[2] - q[5]), 1e-15);
  EXPECT_NEAR(frame.across.s, std::sin(q[2] - q[5]), 1e-15);
}

TEST(PairFrame, PullingIsTheTransposeOfPushing) {
  Rng rng(2);
  for (int trial = 0; trial < 10; ++trial) {
    const PairFrame<double> frame = frame_of(some_poses(rng));
    const Vec4<double> g = some_matrix(rng).col(0);
    Vec6 pulled = Vec6::Zero();
    frame.pull(g, pulled.data(), pulled.data() + 3);
    EXPECT_LT((pulled - pushing(frame).transpose() * g).norm(), 1e-14);
  }
}

TEST(PairFrame, FixedBodiesNeitherPushNorArePulled) {
  Rng rng(3);
  const PairFrame<double> frame = frame_of(some_poses(rng));
  const Vec6 y = Vec6::Ones();
  Vec6 only_i = y, only_j = y;
  only_i.tail<3>().setZero();
  only_j.head<3>().setZero();
  EXPECT_EQ(frame.pushed(y.data(), nullptr), frame.pushed(only_i.data(), only_i.data() + 3));
  EXPECT_EQ(frame.pushed(nullptr, y.data()), frame.pushed(only_j.data(), only_j.data() + 3));
  Vec6 pulled = Vec6::Zero();
  frame.pull({1, 2, 3, 4}, nullptr, pulled.data() + 3);
  EXPECT_EQ(pulled.head<3>().norm(), 0.0);
  EXPECT_GT(pulled.tail<3>().norm(), 0.0);
}

TEST(PairFrame, BlocksAreThoseOfThePulledMatrix) {
  Rng rng(4);
  for (int trial = 0; trial < 10; ++trial) {
    const PairFrame<double> rows = frame_of(some_poses(rng)), columns = frame_of(some_poses(rng));
    const Mat4<double> H = some_matrix(rng);
    const Eigen::Matrix<double, 6, 6> whole = pushing(rows).transpose() * H * pushing(columns);
    const PulledBlocks<double> blocks(rows, H, columns);
    EXPECT_LT((blocks.ii - whole.topLeftCorner<3, 3>()).norm(), 1e-14);
    EXPECT_LT((blocks.ij - whole.topRightCorner<3, 3>()).norm(), 1e-14);
    EXPECT_LT((blocks.ji - whole.bottomLeftCorner<3, 3>()).norm(), 1e-14);
    EXPECT_LT((blocks.jj - whole.bottomRightCorner<3, 3>()).norm(), 1e-14);
  }
}

// Along a motion y the derivatives of Vᵀ g and Vᵀ H V for constant g and H are those of V.
TEST(PairFrame, TurnTermsAreDerivativesOfPulledConstants) {
  Rng rng(5);
  for (int trial = 0; trial < 10; ++trial) {
    const Vec6 q = some_poses(rng), y = testing::test_directions(Vec6::Ones(), rng)[0];
    const Vec4<double> g = some_matrix(rng).col(0);
    const Mat4<double> H = some_matrix(rng);
    const double t = 1e-6;
    const auto V = pushing(frame_of(q));
    const auto up = pushing(frame_of(q + t * y)), down = pushing(frame_of(q - t * y));
    EXPECT_LT(
        (V.transpose() * frame_turn(y[5], g) - (up - down).transpose() * g / (2.0 * t)).norm(),
        1e-9);
    const Mat4<double> rows = row_turn(y[5], H);
    const Mat4<double> columns = row_turn(y[5], Mat4<double>(H.transpose())).transpose();
    EXPECT_LT((V.transpose() * (rows + columns) * V -
               (up.transpose() * H * up - down.transpose() * H * down) / (2.0 * t))
                  .norm(),
              1e-8);
  }
}

}  // namespace
}  // namespace rtg::energy
