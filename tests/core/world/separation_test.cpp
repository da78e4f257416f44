#include "core/world/separation.hpp"

#include <gtest/gtest.h>

#include "core/math/rng.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/random_push.hpp"

namespace rtg {
namespace {

using testing::random_shape;
using Points = std::vector<Vector2d>;

Points placed(const Polygon& shape, const Pose& pose) {
  Points out;
  for (const Vector2d& v : shape.vertices) out.push_back(to_world(pose, v));
  return out;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the part of the convex polygon `subject` to the left of the line from p to q.
Points left_of(const Points& subject, const Vector2d& p, const Vector2d& q) {
  Points out;
  for (std::size_t k = 0; k < subject.size(); ++k) {
    const Vector2d &a = subject[k], &b = subject[(k + 1) % subject.size()];
    const double side_a = cross(q - p, a - p), side_b = cross(q - p, b - p);
    if (side_a >= 0.0) out.push_back(a);
    if (side_a * side_b < 0.0) out.push_back(a + (b - a) * (side_a / (side_a - side_b)));
  }
  return out;
}

/// Area common to two convex polygons, by clipping one with the edges of the other.
double common_area(Points a, const Points& b) {
  for (std::size_t k = 0; k < b.size(); ++k) a = left_of(a, b[k], b[(k + 1) % b.size()]);
  double area = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) area += cross(a[k], a[(k + 1) % a.size()]) / 2.0;
  return area;
}

constexpr int kDirections = 3600;

/// Largest gap between the shadows of two polygons over directions all round: their distance where
/// they are apart, minus their penetration depth where they overlap.
double shadow_gap(const Points& a, const Points& b) {
  double best = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < kDirections; ++k) {
    const Vector2d u = rotate(2.0 * std::numbers::pi * k / kDirections, Vector2d::UnitX());
    double end = -std::numeric_limits<double>::infinity(), begin = -end;
    for (const Vector2d& x : a) end = std::max(end, u.dot(x));
    for (const Vector2d& x : b) begin = std::min(begin, u.dot(x));
    best = std::max(best, begin - end);
  }
  return best;
}

struct Pair {
  Polygon a, b;
  Pose pose_a, pose_b;
  double value() const { return separation(a, pose_a, b, pose_b); }
};

/// Shapes of radius ≤ 1.2 m at most 2.3 m apart in x and y: about half of them overlap.
Pair random_pair(Rng& rng) {
  const auto pose = [&rng] {
    return Pose{rng.uniform(-0.8, 0.8), rng.uniform(-0.8, 0.8), rng.uniform(-9.0, 9.0)};
  };
  Pair pair{random_shape(rng), random_shape(rng), pose(), pose()};
  pair.pose_b.x += rng.uniform(-1.5, 1.5);
  return pair;
}

TEST(Separation, OfBoxesFaceToFaceIsTheirGap) {
  EXPECT_NEAR(separation(box(1.0, 2.0), {0, 0, 0}, box(0.6, 0.6), {1.0, 0.4, 0}), 0.2, 1e-15);
  EXPECT_NEAR(separation(box(1.0, 2.0), {0, 0, 0}, box(0.6, 0.6), {0.7, 0.4, 0}), -0.1, 1e-15);
}

TEST(Separation, OfACornerBeforeAFaceIsTheirGap) {
  const Pose corner_ahead{2.0, 0.1, std::numbers::pi / 4.0};
  const double tip = 2.0 - 0.5 * std::numbers::sqrt2;
  EXPECT_NEAR(separation(box(1, 1), corner_ahead, box(1, 1), {0, 0, 0}), tip - 0.5, 1e-15);
}

TEST(Separation, OfCornerToCornerIsTheLargerOfTheFaceGaps) {
  EXPECT_NEAR(separation(box(1, 1), {0, 0, 0}, box(1, 1), {1.3, 1.4, 0}), 0.4, 1e-15);
}

TEST(Separation, SeesCrossingBarsOfWhichNoVertexLiesInTheOther) {
  EXPECT_NEAR(separation(box(4.0, 0.2), {0, 0, 0}, box(0.2, 4.0), {0, 0, 0}), -2.1, 1e-15);
}

TEST(Separation, IsPositiveExactlyIfNoAreaIsCommon) {
  Rng rng(5);
  int apart = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Pair pair = random_pair(rng);
    const double area = common_area(placed(pair.a, pair.pose_a), placed(pair.b, pair.pose_b));
    ASSERT_EQ(pair.value() > 0.0, area <= 0.0) << "trial " << trial << ", common area " << area;
    apart += pair.value() > 0.0;
  }
  EXPECT_GT(apart, 500);
  EXPECT_LT(apart, 1500);
}

TEST(Separation, IsTheDepthOfThePenetrationAndNeverAboveTheDistance) {
  // Between two directions of the sweep a shadow's end moves by less than the farthest vertex,
  // 3.5 m, times half the angle between them.
  const double tolerance = 3.5 * std::numbers::pi / kDirections;
  Rng rng(6);
  for (int trial = 0; trial < 200; ++trial) {
    const Pair pair = random_pair(rng);
    const double gap = shadow_gap(placed(pair.a, pair.pose_a), placed(pair.b, pair.pose_b));
    ASSERT_LE(pair.value(), gap + tolerance);
    if (gap < 0.0) {
      ASSERT_NEAR(pair.value(), gap, tolerance);
    }
  }
}

TEST(Separation, DoesNotDependOnTheOrderNorOnWhereTheSceneStands) {
  Rng rng(7);
  for (int trial = 0; trial < 100; ++trial) {
    Pair pair = random_pair(rng);
    const double value = pair.value();
    EXPECT_EQ(separation(pair.b, pair.pose_b, pair.a, pair.pose_a), value);
    const double angle = rng.uniform(-3.0, 3.0);
    for (Pose* p : {&pair.pose_a, &pair.pose_b}) {
      const Vector2d at = rotate(angle, p->position()) + Vector2d(3.0, -7.0);
      *p = {at.x(), at.y(), p->theta + angle};
    }
    EXPECT_NEAR(pair.value(), value, 1e-13);
  }
}

Scene three_boxes() {
  Scene scene;
  for (int k = 0; k < 3; ++k) scene.bodies.push_back({"", "box", box(1, 1), 1.0, 0.5, false});
  return scene;
}

using Indices = std::pair<std::size_t, std::size_t>;

TEST(FirstOverlap, NamesTheFirstPairInOrder) {
  const Scene scene = three_boxes();
  EXPECT_EQ(first_overlap(scene, {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}), std::nullopt);
  EXPECT_EQ(first_overlap(scene, {{0, 0, 0}, {2, 0, 0}, {2.5, 0, 0}}), Indices(1, 2));
  EXPECT_EQ(first_overlap(scene, {{0, 0, 0}, {9, 0, 0}, {0.5, 0, 0}}), Indices(0, 2));
  EXPECT_EQ(first_overlap(scene, {{0, 0, 0}, {0.5, 0, 0}, {0.5, 0, 0}}), Indices(0, 1));
}

TEST(FirstOverlap, CountsPairsCloserThanTheMargin) {
  const Scene scene = three_boxes();
  const Poses poses{{0, 0, 0}, {1.1, 0, 0}, {9, 0, 0}};
  EXPECT_EQ(first_overlap(scene, poses, 0.09), std::nullopt);
  EXPECT_EQ(first_overlap(scene, poses, 0.11), Indices(0, 1));
}

TEST(FirstOverlap, ReachesAsFarAsTheMargin) {
  EXPECT_EQ(first_overlap(three_boxes(), {{0, 0, 0}, {5, 0, 0}, {20, 0, 0}}, 4.5), Indices(0, 1));
}

TEST(FirstOverlap, LetsFixedBodiesTouchEachOtherButNothingElse) {
  Scene scene = three_boxes();
  scene.bodies[1].fixed = scene.bodies[2].fixed = true;
  EXPECT_EQ(first_overlap(scene, {{0, 0, 0}, {2, 0, 0}, {2.5, 0, 0}}), std::nullopt);
  EXPECT_EQ(first_overlap(scene, {{2.2, 0, 0}, {0, 0, 0}, {2.5, 0, 0}}), Indices(0, 2));
}

TEST(Separation, BodiesAreApartWhereTheirSeparationIsTheMargin) {
  const Polygon a = box(1.0, 0.4), b = regular_polygon(5, 0.6);
  Rng rng(7);
  int apart = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Pose pose_a{0.0, 0.0, rng.uniform(-3.0, 3.0)};
    const Pose pose_b{rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5), rng.uniform(-3.0, 3.0)};
    for (const double margin : {-0.1, 0.0, 0.2}) {
      const bool expected = separation(a, pose_a, b, pose_b) >= margin;
      EXPECT_EQ(are_apart(a, pose_a, b, pose_b, margin), expected);
      apart += expected;
    }
  }
  EXPECT_GT(apart, 200);
  EXPECT_LT(apart, 1300);
}

TEST(Separation, JointedBodiesMayOverlap) {
  Scene scene{{{"a", "a", box(1, 1), 1.0, 0.5, false}, {"b", "b", box(1, 1), 1.0, 0.5, false}}};
  const Poses poses{{0, 0, 0}, {0.5, 0, 0}};
  EXPECT_TRUE(first_overlap(scene, poses));
  scene.joints.push_back({0, 1, {0.25, 0.0}, {-0.25, 0.0}});
  EXPECT_FALSE(first_overlap(scene, poses));
}

TEST(Separation, DistanceToASegmentIsThatToItsNearestPoint) {
  EXPECT_DOUBLE_EQ(distance_to_segment({1, 2}, {0, 0}, {3, 0}), 2.0);
  EXPECT_DOUBLE_EQ(distance_to_segment({-3, 4}, {0, 0}, {3, 0}), 5.0);
  EXPECT_DOUBLE_EQ(distance_to_segment({6, 4}, {0, 0}, {3, 0}), 5.0);
  EXPECT_DOUBLE_EQ(distance_to_segment({3, 4}, {0, 0}, {0, 0}), 5.0);
}

}  // namespace
}  // namespace rtg
