#include "core/reverse/naive_reverse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/rng.hpp"
#include "core/world/separation.hpp"

namespace rtg::reverse {
namespace {

constexpr auto kDraws = static_cast<std::size_t>(kMaxPredecessors);
constexpr int kRight = 0;  // of 4 actions; the robot comes from the left

/// A square robot of 1 m and objects of the given shapes; pushes of 2 m in an arena of ±8 m.
struct NaiveReverseTest : ::testing::Test {
  Scene scene{{{"robot", "robot", box(1.0, 1.0), 1.0, 0.5, false}}};
  PushConfig push{4, {2.0}, 8.0};
  Poses end{{1.0, 0.5, 0.0}};

  void add(const Polygon& shape, const Pose& pose, bool fixed = false) {
    scene.bodies.push_back({"", "", shape, 1.0, 0.5, fixed});
    end.push_back(pose);
  }

  ReverseResult solve(int action = kRight) const {
    return NaiveReverse(scene, push).solve({end, action});
  }

  void expect_pulled(std::size_t body) const {
    const ReverseResult result = solve();
    ASSERT_EQ(result.status, SolveStatus::kConverged);
    ASSERT_EQ(result.predecessors.size(), body == 0 ? 1U : kDraws);
    for (const Poses& start : result.predecessors) expect_pulled(body, start);
  }

  void expect_pulled(std::size_t body, const Poses& start) const {
    for (std::size_t k = 0; k < end.size(); ++k) {
      const double pull = end[k].x - start[k].x;
      EXPECT_EQ(start[k].y, end[k].y);
      EXPECT_EQ(start[k].theta, end[k].theta);
      if (k == 0) {
        EXPECT_NEAR(pull, 2.0, 1e-15);
      } else if (k == body) {
        EXPECT_GE(pull, 0.4);  // a fifth of the stride
        EXPECT_LE(pull, 2.0);
      } else {
        EXPECT_EQ(pull, 0.0);
      }
    }
  }
};

TEST_F(NaiveReverseTest, FreeRobotStepsBackOneStride) {
  add(box(1, 1), {5.0, 5.0, 0.3});
  const std::vector<Vector2d> back{{-2, 0}, {0, -2}, {2, 0}, {0, 2}};
  for (int action = 0; action < 4; ++action) {
    const ReverseResult result = solve(action);
    EXPECT_EQ(result.status, SolveStatus::kConverged);
    EXPECT_EQ(result.iterations, 0);
    const Vector2d moved = result.predecessors[0][0].position() - end[0].position();
    EXPECT_LT((moved - back[static_cast<std::size_t>(action)]).norm(), 1e-14);
    EXPECT_EQ(result.predecessors[0][0].theta, end[0].theta);
    EXPECT_EQ(result.predecessors[0][1], end[1]);
  }
}

TEST_F(NaiveReverseTest, PullsTheObjectInFrontWithItUnturned) {
  add(box(1, 1), {2.1, 0.6, 0.0});
  expect_pulled(1);
}

TEST_F(NaiveReverseTest, PullsAnObjectThatItOverlaps) {
  add(box(1, 1), {1.85, 0.5, 0.0});  // by 0.15 m
  expect_pulled(1);
}

TEST_F(NaiveReverseTest, PullsNothingThatIsOutOfReach) {
  add(box(1, 1), {2.21, 0.5, 0.0});  // 0.21 m ahead
  expect_pulled(0);
}

TEST_F(NaiveReverseTest, PullsNothingThatTouchesItFromTheSide) {
  add(box(1, 1), {1.0, 1.6, 0.0});
  expect_pulled(0);
}

TEST_F(NaiveReverseTest, PullsTheNearestOfTwo) {
  add(box(0.4, 0.4), {1.85, 0.9, 0.0});  // 0.15 m ahead
  add(box(0.4, 0.4), {1.75, 0.1, 0.0});  // 0.05 m ahead
  expect_pulled(2);
  std::swap(end[1], end[2]);
  expect_pulled(1);
}

TEST_F(NaiveReverseTest, PullsNoFixedBody) {
  add(box(1, 1), {2.05, 0.5, 0.0}, true);
  expect_pulled(0);
}

TEST_F(NaiveReverseTest, ThePullIsAFunctionOfTheJobSpreadOverItsRange) {
  add(box(1, 1), {2.1, 0.5, 0.0});
  double least = INFINITY, most = 0.0, mean = 0.0;
  for (int k = 0; k < 125; ++k) {
    end[1].theta = 1e-4 * k;
    const ReverseResult result = solve();
    ASSERT_EQ(result.predecessors, solve().predecessors);
    for (const Poses& start : result.predecessors) {
      const double pull = end[1].x - start[1].x;
      least = std::min(least, pull);
      most = std::max(most, pull);
      mean += pull / 1000.0;
    }
  }
  // 1000 even draws from [0.4, 2]: standard deviation of the mean 1.6/√12/√1000 = 0.015.
  EXPECT_NEAR(mean, 1.2, 5 * 0.015);
  EXPECT_LT(least, 0.42);
  EXPECT_GT(most, 1.98);
}

TEST_F(NaiveReverseTest, BodyOnTheWayBackPrunes) {
  add(box(0.2, 0.2), {-0.7, 0.5, 0.0});
  EXPECT_EQ(solve().status, SolveStatus::kPruned);
  EXPECT_EQ(solve(2).status, SolveStatus::kConverged);  // the way to the other side is clear
  end[1].y = 1.2;                                       // beside the way
  EXPECT_EQ(solve().status, SolveStatus::kConverged);
  end[1] = {-1.61, 0.5, 0.0};  // behind where it ends
  EXPECT_EQ(solve().status, SolveStatus::kConverged);
  end[1].x = -1.59;  // touched at its end alone
  EXPECT_EQ(solve().status, SolveStatus::kPruned);
}

TEST_F(NaiveReverseTest, FixedBodyOnTheWayBackPrunes) {
  add(box(0.2, 0.2), {0.0, 0.5, 0.0}, true);
  EXPECT_EQ(solve().status, SolveStatus::kPruned);
}

TEST_F(NaiveReverseTest, ThinWallAcrossTheWayBackPrunes) {
  add(box(0.01, 4.0), {-0.5, 0.5, 0.0}, true);
  EXPECT_EQ(solve().status, SolveStatus::kPruned);
}

TEST_F(NaiveReverseTest, PulledObjectThatWouldOverlapAnotherIsInfeasible) {
  add(box(1.0, 4.0), {2.1, 0.5, 0.0});
  add(box(2.0, 0.5), {0.25, 2.0, 0.0});  // beside the robot's way, 0.35 m behind the object
  EXPECT_EQ(solve().status, SolveStatus::kInfeasible);
}

TEST_F(NaiveReverseTest, RobotThatWouldStartOutsideTheArenaPrunes) {
  end[0] = {-6.01, 0.0, 0.0};
  EXPECT_EQ(solve().status, SolveStatus::kPruned);
  EXPECT_EQ(solve(2).status, SolveStatus::kConverged);
  end[0].x = -5.99;
  EXPECT_EQ(solve().status, SolveStatus::kConverged);
}

TEST_F(NaiveReverseTest, PullsThatOverlapAreLeftOut) {
  add(box(1, 1), {2.1, 0.5, 0.0});
  end[1].y = 1.2;
  add(box(0.1, 4.0), {0.7, 3.2, 0.0});  // beside the robot's way, but not the object's
  const ReverseResult result = solve();
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT(result.predecessors.size(), kDraws);
  for (const Poses& start : result.predecessors) EXPECT_FALSE(first_overlap(scene, start));
}

TEST_F(NaiveReverseTest, WhatJointsConnectIsPulledAsOne) {
  add(box(1, 1), {2.1, 0.5, 0.0});
  add(box(1, 1), {3.3, 0.5, 0.0});
  scene.joints.push_back({1, 2, {0.6, 0.0}, {-0.6, 0.0}});
  const ReverseResult result = solve();
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  for (const Poses& start : result.predecessors)
    EXPECT_NEAR(end[1].x - start[1].x, end[2].x - start[2].x, 1e-12);
}

TEST_F(NaiveReverseTest, WhatHangsOnAFixedBodyIsNotPulled) {
  add(box(1, 1), {2.1, 0.5, 0.0});
  add(box(1, 1), {3.3, 0.5, 0.0}, true);
  scene.joints.push_back({2, 1, {-0.6, 0.0}, {0.6, 0.0}});
  EXPECT_EQ(solve().status, SolveStatus::kInfeasible);
}

TEST_F(NaiveReverseTest, WhatSlidesOnAFixedBodyMovesAlongItsAxis) {
  add(box(1, 1), {2.1, 0.5, 0.0});
  add(box(1, 1), {3.3, 0.5, 0.0}, true);
  scene.joints.push_back({2, 1, {-1.2, 0.0}, {0.0, 0.0}});
  scene.joints[0].type = JointType::kPrismatic;
  scene.joints[0].axis = Vector2d(0.6, 0.8);
  const ReverseResult result = solve();
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  for (const Poses& start : result.predecessors) {
    EXPECT_LT(joint_gap(scene.joints[0], start), 1e-12);
    EXPECT_LT(joint_value(scene.joints[0], start), -0.1);
  }
}

TEST_F(NaiveReverseTest, AnswersWithFiniteStartsOfAllBodiesOrNone) {
  Rng rng(41);
  add(box(1, 1), {});
  add(box(1, 2), {});
  for (int trial = 0; trial < 300; ++trial) {
    for (Pose& p : end) p = {rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-9, 9)};
    const ReverseResult result = solve(rng.below(4));
    ASSERT_EQ(!result.predecessors.empty(), result.status == SolveStatus::kConverged);
    ASSERT_LE(result.predecessors.size(), kDraws);
    for (const Poses& start : result.predecessors) {
      ASSERT_EQ(start.size(), 3U);
      ASSERT_TRUE(is_finite(start));
    }
  }
}

}  // namespace
}  // namespace rtg::reverse
