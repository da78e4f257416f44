#include "core/search/ways.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/math/rng.hpp"
#include "core/world/separation.hpp"

namespace rtg::search {
namespace {

/// A robot and walls, of which each is a shape at a pose.
struct Walls {
  Scene scene{{{"robot", "robot", box(1, 1)}}};
  Poses poses{{0, 0, 0}};

  void add(const Shape& shape, const Pose& pose) {
    scene.bodies.push_back({"wall", "wall", shape, 1.0, 0.5, true});
    poses.push_back(pose);
  }
  Ways ways(double clearance) const {
    std::vector<std::size_t> all(scene.size() - 1);
    std::iota(all.begin(), all.end(), std::size_t{1});
    return {scene, poses, all, clearance, 8.0};
  }
};

TEST(Ways, AreStraightWithoutObstaclesAndPastThem) {
  Walls walls;
  EXPECT_EQ(Ways().between({0, 0}, {3, 4}).length, 5.0);
  walls.add(box(2, 2), {0, 0, 0});
  const Ways::Way way = walls.ways(0.5).between({-4, 3}, {4, 3});
  EXPECT_EQ(way.length, 8.0);
  EXPECT_EQ(way.next, Vector2d(4, 3));
}

TEST(Ways, BendAtTheCornersOfWhatIsInBetween) {
  Walls walls;
  walls.add(box(2, 2), {0, 0.3, 0});  // widened: |x| ≤ 1.5, -1.2 ≤ y ≤ 1.8
  const Ways::Way way = walls.ways(0.5).between({-4, 0}, {4, 0});
  EXPECT_NEAR(way.length, 2.0 * std::hypot(2.5, 1.2) + 3.0, 0.01);
  EXPECT_LT((way.next - Vector2d(-1.5, -1.2)).norm(), 0.01);
}

TEST(Ways, GoThroughDoorwaysThatAreWideEnough) {
  Walls walls;
  walls.add(box(10, 0.6), {-3, -2, 0});
  walls.add(box(2.4, 0.6), {6.8, -2, 0});  // a doorway from 2 to 5.6
  walls.add(box(2.4, 0.6), {-6.8, 2.5, 0});
  walls.add(box(10, 0.6), {3, 2.5, 0});  // and one from -5.6 to -2
  const Vector2d from(-3, -4.5), to(3, 5.5);
  const double length = walls.ways(0.5).between(from, to).length;
  EXPECT_GT(length, 1.6 * (to - from).norm());
  EXPECT_LT(length, 2.2 * (to - from).norm());
  EXPECT_EQ(walls.ways(2.0).between(from, to).length, (to - from).norm() + 16.0)
      << "there is no way";
}

TEST(Ways, GoAroundDiscsAndUnions) {
  Walls walls;
  walls.add(Shape(disc(1.0)), {0, 0, 0});
  const double around = 2.0 * std::sqrt(16.0 - 2.25) + 1.5 * 2.0 * std::asin(1.5 / 4.0);
  EXPECT_NEAR(walls.ways(0.5).between({-4, 0}, {4, 0}).length, around, 0.1);
  walls.add(Shape({{box(1, 6)}, {box(6, 1)}}), {0, 0, 0});
  EXPECT_GT(walls.ways(0.2).between({-4, 0.5}, {4, 0.5}).length, 9.5);
}

TEST(Ways, FromWithinAnObstacleDoNotPassThroughIt) {
  Walls walls;
  walls.add(box(10, 1), {0, 0, 0});  // widened: |y| ≤ 1
  const Ways ways = walls.ways(0.5);
  EXPECT_EQ(ways.between({0, -0.8}, {0, -4}).length, 3.2);
  EXPECT_NEAR(ways.between({0, -0.8}, {0, 0.8}).length, 2.0 * std::hypot(5.5, 0.2) + 2.0, 0.01);
}

// Triangle inequality, symmetry, and never shorter than the straight line.
TEST(Ways, AreAMetricInFreeSpace) {
  Walls walls;
  walls.add(box(6, 0.5), {0, 1, 0.4});
  walls.add(box(5, 0.5), {-2, -3, 1.2});
  const Ways ways = walls.ways(0.3);
  Rng rng(1);
  const auto point = [&] {
    for (;;) {  // outside of the widened walls
      const Pose at{rng.uniform(-7, 7), rng.uniform(-7, 7), 0.0};
      double least = INFINITY;
      for (std::size_t k = 1; k < walls.poses.size(); ++k)
        least = std::min(
            least, separation(Shape(disc(0.45)), at, walls.scene.bodies[k].shape, walls.poses[k]));
      if (least > 0.0) return at.position();
    }
  };
  for (int k = 0; k < 200; ++k) {
    const Vector2d a = point(), b = point(), c = point();
    const double ab = ways.between(a, b).length;
    EXPECT_GE(ab, (a - b).norm() - 1e-12);
    EXPECT_NEAR(ab, ways.between(b, a).length, 1e-12);
    EXPECT_LE(ways.between(a, c).length, ab + ways.between(b, c).length + 0.02);
  }
}

TEST(LeastHalfWidth, IsThatOfTheNarrowestGap) {
  EXPECT_NEAR(least_half_width(box(2, 0.6)), 0.3, 1e-12);
  EXPECT_NEAR(least_half_width(Shape(disc(0.7))), 0.7, 1e-12);
  EXPECT_NEAR(least_half_width(regular_polygon(6, 1.0)), std::sqrt(0.75), 0.01);
}

}  // namespace
}  // namespace rtg::search
