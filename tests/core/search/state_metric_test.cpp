#include "core/search/state_metric.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/math/rng.hpp"

namespace rtg::search {
namespace {

constexpr double kPi = std::numbers::pi;

Body body(const Polygon& shape, bool fixed = false) { return {"", "", shape, 1.0, 0.5, fixed}; }

/// Robot, square, wall, triangle, trapezium: orders 4, 3 and 1.
Scene mixed_scene() {
  const Polygon trapezium = centred({{{-1, 0}, {1, 0}, {0.5, 1}, {-0.5, 1}}});
  return {{body(regular_polygon(6, 0.8)), body(box(1.2, 1.2)), body(box(4, 1), true),
           body(regular_polygon(3, 0.7)), body(trapezium)}};
}

constexpr std::array<std::size_t, 3> kObjects{1, 3, 4};
constexpr std::array<int, 3> kOrders{4, 3, 1};

Poses random_poses(Rng& rng, double extent = 4.0) {
  Poses poses(5);
  for (Pose& p : poses)
    p = {rng.uniform(-extent, extent), rng.uniform(-extent, extent), rng.uniform(-9.0, 9.0)};
  return poses;
}

/// `a` with every object turned by some of its symmetries and with what does not count changed.
Poses look_alike(Poses a, Rng& rng) {
  for (std::size_t k = 0; k < kObjects.size(); ++k)
    a[kObjects[k]].theta += 2.0 * kPi / kOrders[k] * (rng.below(9) - 4);
  a[0].theta += 1.0;
  a[2] = {7.0, 7.0, 7.0};
  return a;
}

/// Angle between two headings of a shape that looks the same after every 2π/order.
double naive_angle(double a, double b, int order) {
  double least = INFINITY;
  for (int turn = -40; turn <= 40; ++turn)
    least = std::min(least, std::abs(a - b + 2.0 * kPi * turn / order));
  return least;
}

TEST(StateMetric, ObjectsAreTheMovableBodiesButTheRobot) {
  const Scene scene = mixed_scene();
  const StateMetric metric(scene);
  ASSERT_EQ(metric.objects().size(), kObjects.size());
  for (std::size_t k = 0; k < kObjects.size(); ++k) {
    EXPECT_EQ(metric.objects()[k].body, kObjects[k]);
    EXPECT_EQ(metric.objects()[k].turn, 2.0 * kPi / kOrders[k]);
  }
}

TEST(StateMetric, WhatHangsOnAJointLooksTheSameAfterWholeTurnsAlone) {
  Scene scene{{body(regular_polygon(6, 0.8)), body(box(1, 1)), body(box(1, 1)), body(box(1, 1))}};
  scene.joints.push_back({1, 2, {0.5, 0.0}, {-0.5, 0.0}});
  const StateMetric metric(scene);
  const Poses poses(4);
  for (const std::size_t k : {1U, 2U, 3U}) {
    Poses turned = poses;
    turned[k].theta = kPi / 2.0;
    EXPECT_NEAR(metric.layout_distance(poses, turned), k == 3 ? 0.0 : kPi / 4.0, 1e-12);
    turned[k].theta = 2.0 * kPi;
    EXPECT_NEAR(metric.layout_distance(poses, turned), 0.0, 1e-12);
  }
}

TEST(StateMetric, StatesThatLookTheSameAreTheSame) {
  const StateMetric metric(mixed_scene());
  Rng rng(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Poses a = random_poses(rng), b = look_alike(a, rng);
    EXPECT_NEAR(metric.layout_distance(a, b), 0.0, 1e-13);
  }
}

TEST(StateMetric, LayoutDistanceMatchesANaiveSum) {
  const StateMetric metric(mixed_scene());
  Rng rng(6);
  for (int trial = 0; trial < 100; ++trial) {
    const Poses a = random_poses(rng), b = random_poses(rng);
    double layout = 0.0;
    for (std::size_t k = 0; k < kObjects.size(); ++k) {
      const Pose &p = a[kObjects[k]], &q = b[kObjects[k]];
      layout += std::hypot(p.x - q.x, p.y - q.y) + 0.5 * naive_angle(p.theta, q.theta, kOrders[k]);
    }
    EXPECT_NEAR(metric.layout_distance(a, b), layout, 1e-12);
  }
}

/// The cell as a list of coordinates instead of a hash: 0.8 m for the robot, 0.4 m and about
/// 0.4 rad for the objects.
std::vector<long> naive_cell(const Poses& poses) {
  const auto along = [](double x, double side) { return static_cast<long>(std::floor(x / side)); };
  std::vector<long> cell{along(poses[0].x, 0.8), along(poses[0].y, 0.8)};
  for (std::size_t k = 0; k < kObjects.size(); ++k) {
    const Pose& p = poses[kObjects[k]];
    const double period = 2.0 * kPi / kOrders[k];
    const double slots = std::max(1.0, std::round(period / 0.4));
    const double share = p.theta / period - std::floor(p.theta / period);
    cell.push_back(along(p.x, 0.4));
    cell.push_back(along(p.y, 0.4));
    cell.push_back(std::lround(std::floor(share * slots)) % std::lround(slots));
  }
  return cell;
}

TEST(StateMetricCell, NamesAreOneToOneWithNaiveCells) {
  const StateMetric metric(mixed_scene());
  Rng rng(7);
  std::map<std::vector<long>, std::uint64_t> names;
  std::map<std::uint64_t, std::vector<long>> cells_of;
  for (int trial = 0; trial < 5000; ++trial) {
    const Poses poses = random_poses(rng);
    const std::vector<long> naive = naive_cell(poses);
    const std::uint64_t name = metric.cell(poses);
    ASSERT_EQ(names.emplace(naive, name).first->second, name);
    ASSERT_EQ(cells_of.emplace(name, naive).first->second, naive);
  }
}

TEST(StateMetricCell, LinesOfTheRobotAreItsOwn) {
  const StateMetric metric(mixed_scene());
  Poses a(5, {0.1, 0.1, 0.1}), b = a, c = a;
  b[0] = {0.7, 0.7, 3.0};
  c[0] = {0.9, 0.7, 3.0};
  EXPECT_EQ(metric.cell(a), metric.cell(b));
  EXPECT_NE(metric.cell(a), metric.cell(c));
}

TEST(StateMetricCell, AnglesGoRoundWithThePeriodOfTheShape) {
  const StateMetric metric(mixed_scene());
  Rng rng(8);
  Poses a(5, {0.1, 0.1, 0.6});
  for (int trial = 0; trial < 50; ++trial)
    EXPECT_EQ(metric.cell(look_alike(a, rng)), metric.cell(a));
  Poses below = a;
  below[1].theta = 0.3;  // across the line at π/8
  EXPECT_NE(metric.cell(below), metric.cell(a));
}

}  // namespace
}  // namespace rtg::search
