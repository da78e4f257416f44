#include "core/reverse/pruning.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/forward/box2d_simulator.hpp"
#include "core/math/rng.hpp"
#include "core/world/separation.hpp"
#include "tests/support/random_push.hpp"

namespace rtg::reverse {
namespace {

const PushConfig kPush;

/// Extent of a shape at heading `theta` across the direction `along` [m].
double width_across(const Polygon& shape, double theta, const Vector2d& along) {
  const Vector2d across = Vector2d(-along.y(), along.x()).normalized();
  double least = INFINITY, most = -INFINITY;
  for (const Vector2d& v : shape.vertices) {
    least = std::min(least, across.dot(rotate(theta, v)));
    most = std::max(most, across.dot(rotate(theta, v)));
  }
  return most - least;
}

// A convex body sweeps over its own area and a parallelogram of its width times the way.
TEST(Swept, AreaIsTheBodysAndTheWaysTimesTheWidth) {
  Rng rng(1);
  for (const Polygon& shape : {box(1.2, 0.7), regular_polygon(6, 0.8), regular_polygon(3, 0.5)})
    for (int trial = 0; trial < 10; ++trial) {
      const double theta = rng.uniform(-3.0, 3.0);
      const Vector2d by(rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0));
      const Polygon way = swept(shape, theta, by)[0].core;
      EXPECT_EQ(polygon_defect(std::span(way.vertices).first(3)), std::nullopt);
      EXPECT_NEAR(moments(way).area,
                  moments(shape).area + by.norm() * width_across(shape, theta, by), 1e-12);
    }
}

TEST(Swept, ContainsTheBodyAllAlongItsWay) {
  const Polygon shape = regular_polygon(5, 0.8);
  const Vector2d by(-1.0, 1.5);
  const Polygon way = swept(shape, 0.4, by)[0].core;
  for (const double share : {0.0, 0.3, 1.0})
    for (const Vector2d& v : shape.vertices) {
      const Vector2d at = v + share * rotate(-0.4, by);
      for (std::size_t k = 0; k < way.size(); ++k) {
        const Vector2d edge = way.vertices[(k + 1) % way.size()] - way.vertices[k];
        const Vector2d from = at - way.vertices[k];
        EXPECT_GE(edge.x() * from.y() - edge.y() * from.x(), -1e-12);
      }
    }
}

TEST(Swept, StandingStillIsTheBodyItself) {
  EXPECT_NEAR(moments(swept(box(1.2, 0.7), 0.3, {0, 0})[0].core).area, 0.84, 1e-12);
}

/// The hexagonal robot, 0.8 from centre to vertex, and a box.
Scene robot_and_box() {
  return {{{"robot", "robot", regular_polygon(6, 0.8), 1.0, 0.5, false},
           {"box", "box", box(1.2, 1.2), 1.0, 0.5, false}}};
}

bool pruned(const Pose& robot, const Pose& other, int action) {
  return is_pruned(robot_and_box(), kPush, {{robot, other}, action});
}

TEST(Pruning, ABodyBehindTheRobotPrunesThePushAwayFromIt) {
  EXPECT_TRUE(pruned({0, 0, 0}, {-1.45, 0, 0}, 0));     // pushed to the right, from inside the box
  EXPECT_TRUE(pruned({0, 0, 0}, {-2.5, 0, 0}, 0));      // met on the way back
  EXPECT_FALSE(pruned({0, 0, 0}, {-3.45, 0, 0}, 0));    // just beyond the stride
  EXPECT_FALSE(pruned({0, 0, 0}, {1.45, 0, 0}, 0));     // pushed ahead
  EXPECT_TRUE(pruned({0, 0, 0}, {1.45, 0, 0}, 24));     // to the left: the box is behind
  EXPECT_FALSE(pruned({0, 0, 0}, {-1.0, 1.35, 0}, 0));  // beside the way
}

TEST(Pruning, AWayBackOutOfTheArenaIsPruned) {
  const Pose far{7, 7, 0};
  EXPECT_FALSE(pruned({-5.9, 0, 0}, far, 0));
  EXPECT_TRUE(pruned({-6.1, 0, 0}, far, 0));
  EXPECT_FALSE(pruned({-6.1, 0, 0}, far, 24));
}

TEST(Pruning, ContactAtTheEndByBox2dsSlopIsNoObstacle) {
  EXPECT_FALSE(pruned({0, 0, 0}, {1.39, 0, 0}, 0));
  EXPECT_FALSE(pruned({0, 0, 0}, {0, 0.8 * std::sqrt(0.75) + 0.595, 0}, 0));  // slides along it
}

/// Least separation of robot and box on the way back, sampled every 5 mm.
double least_separation(const Pose& robot, const Pose& other, int action) {
  const Scene scene = robot_and_box();
  double least = INFINITY;
  for (int k = 0; k <= 400; ++k) {
    const Vector2d at =
        robot.position() - longest_stride(kPush) * k / 400.0 * direction(action, kPush);
    least = std::min(least, separation(scene.bodies[0].shape, {at.x(), at.y(), robot.theta},
                                       scene.bodies[1].shape, other));
  }
  return least;
}

TEST(Pruning, AgreesWithASampledWayBack) {
  Rng rng(2);
  int hits = 0, misses = 0;
  while (hits < 50 || misses < 50) {
    const Pose robot{0, 0, rng.uniform(-3, 3)};
    const Pose other{rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3)};
    const int action = rng.below(48);
    const Scene scene = robot_and_box();
    if (separation(scene.bodies[0].shape, robot, scene.bodies[1].shape, other) < 0.0) continue;
    const double least = least_separation(robot, other, action);
    if (least < -0.011) {
      EXPECT_TRUE(pruned(robot, other, action));
      ++hits;
    } else if (least > -0.004) {
      EXPECT_FALSE(pruned(robot, other, action));
      ++misses;
    }
  }
}

TEST(Pruning, TheActionThatLedToAStateIsNeverPruned) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const testing::RandomPush drawn = testing::random_push(seed, kPush);
    const forward::PushOutcome box2d =
        forward::Box2dSimulator(drawn.scene, kPush, {}).push(drawn.start, drawn.action);
    ASSERT_TRUE(box2d.ok);
    EXPECT_FALSE(is_pruned(drawn.scene, kPush, {box2d.end, drawn.action})) << seed;
  }
}

// A link may have swung in behind the robot; a post that links hang on has not.
TEST(Pruning, OnlyWhatMovesOnAJointMayHaveSwungInBehindTheRobot) {
  Scene scene = robot_and_box();
  scene.bodies.push_back({"link", "link", box(1.2, 1.2), 1.0, 0.5, false});
  scene.joints.push_back({1, 2, {0.6, 0.0}, {-0.6, 0.0}, -1.0, 1.0});
  const Poses end{{0, 0, 0}, {-2.8, 0, 0}, {-4.0, 0, 0}};  // 0.6 m into the way
  EXPECT_FALSE(is_pruned(scene, kPush, {end, 0}));
  scene.bodies[1].fixed = true;
  EXPECT_TRUE(is_pruned(scene, kPush, {end, 0}));
}

/// Robot and four boxes.
Scene five_bodies() {
  Scene scene = robot_and_box();
  for (int k = 0; k < 3; ++k) scene.bodies.push_back(scene.bodies[1]);
  return scene;
}

constexpr double kRange = 0.15;

TEST(RelevantBodies, AreThoseWithinRangeOfTheWayBack) {
  // Ahead within the range, ahead beyond it, beside the way within and beyond.
  const double side = 0.8 * std::sqrt(0.75) + 0.6;
  const Poses end{{0, 0, 0}, {1.5, 0, 0}, {6, 6, 0}, {-1.9, side + 0.1, 0}, {-1.9, -side - 0.2, 0}};
  EXPECT_EQ(relevant_bodies(five_bodies(), kPush, {end, 0}, kRange), (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(relevant_bodies(five_bodies(), kPush, {end, 24}, kRange), (std::vector<int>{0, 1}));
}

TEST(RelevantBodies, AreAlsoThoseOnTheWaysOfOthers) {
  // Box 1 ahead of the robot was dragged along y = 0, past box 2; box 3 is past box 2's way.
  const Poses end{{0, 0, 0}, {1.5, 0, 0}, {0.9, 1.3, 0}, {-0.5, 2.6, 0}, {6, 6, 0}};
  EXPECT_EQ(relevant_bodies(five_bodies(), kPush, {end, 0}, kRange),
            (std::vector<int>{0, 1, 2, 3}));
}

// A link ahead of the robot was pushed, and swung past a box that is not on its straight way.
TEST(RelevantBodies, AreAlsoThoseThatALinkMaySwingPast) {
  Scene scene = five_bodies();
  const Poses end{{0, 0, 0}, {1.5, 0, 0}, {1.5, 2.4, 0}, {-6, -6, 0}, {6, 6, 0}};
  EXPECT_EQ(relevant_bodies(scene, kPush, {end, 0}, kRange), (std::vector<int>{0, 1}));
  scene.joints.push_back({3, 1, {0.6, 0.0}, {-0.6, 0.0}});
  EXPECT_EQ(relevant_bodies(scene, kPush, {end, 0}, kRange), (std::vector<int>{0, 1, 2, 3}));
}

TEST(RelevantBodies, FixedOnesComeLastAndPassNothingOn) {
  Scene scene = five_bodies();
  scene.bodies[1].fixed = true;
  const double side = 0.8 * std::sqrt(0.75) + 0.6;
  const Poses end{{0, 0, 0}, {1.5, 0, 0}, {2.75, 0, 0}, {0, side + 0.1, 0}, {6, 6, 0}};
  EXPECT_EQ(relevant_bodies(scene, kPush, {end, 0}, kRange), (std::vector<int>{0, 3, 1}));
}

}  // namespace
}  // namespace rtg::reverse
