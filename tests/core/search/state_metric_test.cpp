#include "core/search/state_metric.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/math/rng.hpp"

namespace rtg {
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

TEST(SymmetryOrder, CountsTheTurnsThatMapAShapeOntoItself) {
  for (int sides = 3; sides <= 8; ++sides)
    EXPECT_EQ(symmetry_order(regular_polygon(sides, 0.8)), sides);
  EXPECT_EQ(symmetry_order(box(1.2, 1.2)), 4);
  EXPECT_EQ(symmetry_order(box(1.2, 0.7)), 2);
  EXPECT_EQ(symmetry_order({{{1, 0}, {0, 2}, {-1, 0}, {0, -2}}}), 2);               // a rhombus
  EXPECT_EQ(symmetry_order(centred({{{-1, 0}, {1, 0}, {0, 3}}})), 1);               // isosceles
  EXPECT_EQ(symmetry_order(centred({{{-1, 0}, {1, 0}, {0.5, 1}, {-0.5, 1}}})), 1);  // trapezium
}

TEST(SymmetryOrder, OfAHexagonWithTwoKindsOfCornersIsThree) {
  Polygon shape = regular_polygon(6, 0.8);
  for (std::size_t k = 0; k < 6; k += 2) shape.vertices[k] *= 1.2;
  EXPECT_EQ(symmetry_order(shape), 3);
}

TEST(SymmetryOrder, OfAnAlmostSquareBoxIsTwo) { EXPECT_EQ(symmetry_order(box(1.2, 1.201)), 2); }

TEST(AngleDifference, IsTheLeastOfAllThatLookTheSame) {
  Rng rng(2);
  for (int trial = 0; trial < 300; ++trial) {
    const int order = 1 + rng.below(8);
    const double a = rng.uniform(-9.0, 9.0), b = rng.uniform(-9.0, 9.0);
    const double d = angle_difference(a, b, order);
    EXPECT_NEAR(std::abs(d), naive_angle(a, b, order), 1e-13);
    EXPECT_NEAR(naive_angle(b + d, a, order), 0.0, 1e-13);  // b turned by it looks like a
  }
}

TEST(StateMetric, ObjectsAreTheMovableBodiesButTheRobot) {
  const Scene scene = mixed_scene();
  const StateMetric metric(scene);
  ASSERT_EQ(metric.objects().size(), kObjects.size());
  for (std::size_t k = 0; k < kObjects.size(); ++k) {
    EXPECT_EQ(metric.objects()[k].body, kObjects[k]);
    EXPECT_EQ(metric.objects()[k].order, kOrders[k]);
  }
  EXPECT_EQ(metric.size(), 2 + 4 * 3);
}

TEST(StateMetric, WhatHangsOnAJointLooksTheSameAfterWholeTurnsAlone) {
  Scene scene{{body(regular_polygon(6, 0.8)), body(box(1, 1)), body(box(1, 1)), body(box(1, 1))}};
  scene.joints.push_back({1, 2, {0.5, 0.0}, {-0.5, 0.0}});
  const StateMetric metric(scene);
  const Poses poses(4);
  for (const std::size_t k : {1U, 2U, 3U}) {
    Poses turned = poses;
    turned[k].theta = kPi / 2.0;
    EXPECT_NEAR(metric.spread(poses, turned).angle, k == 3 ? 0.0 : kPi / 2.0, 1e-12);
    turned[k].theta = 2.0 * kPi;
    EXPECT_NEAR(metric.spread(poses, turned).angle, 0.0, 1e-12);
  }
}

TEST(StateMetric, DistanceIsTheNormOfTheNaiveEmbeddings) {
  // Weight 1.5 of objects, angles at a radius of 0.5 m; a chord of an angle d is 2 sin(d/2).
  const StateMetric metric(mixed_scene());
  Rng rng(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Poses a = random_poses(rng), b = random_poses(rng);
    double sum = (a[0].position() - b[0].position()).squaredNorm();
    for (std::size_t k = 0; k < kObjects.size(); ++k) {
      const Pose &p = a[kObjects[k]], &q = b[kObjects[k]];
      const double order = kOrders[k];
      const double chord = 2.0 * 0.5 / order * std::sin(order * (p.theta - q.theta) / 2.0);
      sum += 1.5 * 1.5 * ((p.position() - q.position()).squaredNorm() + chord * chord);
    }
    EXPECT_NEAR(metric.distance(a, b), std::sqrt(sum), 1e-5);  // single precision of up to 10 m
  }
}

TEST(StateMetric, EmbeddingIsWhatTheDistanceMeasures) {
  const StateMetric metric(mixed_scene());
  Rng rng(4);
  const Poses a = random_poses(rng), b = random_poses(rng);
  std::vector<float> u(14), v(14);
  metric.embed(a, u);
  metric.embed(b, v);
  double sum = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) sum += std::pow(u[k] - v[k], 2);
  EXPECT_NEAR(metric.distance(a, b), std::sqrt(sum), 1e-6);
}

TEST(StateMetric, StatesThatLookTheSameAreTheSamePoint) {
  const StateMetric metric(mixed_scene());
  Rng rng(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Poses a = random_poses(rng), b = look_alike(a, rng);
    EXPECT_NEAR(metric.distance(a, b), 0.0, 2e-6);  // single precision
    EXPECT_NEAR(metric.layout_distance(a, b), 0.0, 1e-13);
    EXPECT_NEAR(metric.spread(a, b).position, 0.0, 0.0);
    EXPECT_NEAR(metric.spread(a, b).angle, 0.0, 1e-13);
  }
}

TEST(StateMetric, LayoutDistanceAndSpreadMatchNaiveSumsAndMaxima) {
  const StateMetric metric(mixed_scene());
  Rng rng(6);
  for (int trial = 0; trial < 100; ++trial) {
    const Poses a = random_poses(rng), b = random_poses(rng);
    double layout = 0.0, position = 0.0, angle = 0.0;
    for (std::size_t k = 0; k < kObjects.size(); ++k) {
      const Pose &p = a[kObjects[k]], &q = b[kObjects[k]];
      const double turn = naive_angle(p.theta, q.theta, kOrders[k]);
      layout += std::hypot(p.x - q.x, p.y - q.y) + 0.5 * turn;
      position = std::max({position, std::abs(p.x - q.x), std::abs(p.y - q.y)});
      angle = std::max(angle, turn);
    }
    EXPECT_NEAR(metric.layout_distance(a, b), layout, 1e-12);
    EXPECT_NEAR(metric.spread(a, b).position, position, 1e-12);
    EXPECT_NEAR(metric.spread(a, b).angle, angle, 1e-12);
  }
}

/// The cell as a list of coordinates instead of a hash.
std::vector<long> naive_cell(const Poses& poses, const StateMetric::Cells& cells) {
  const auto along = [&](double x, double side) {
    return std::lround(std::floor(x / side + cells.shift));
  };
  std::vector<long> cell{along(poses[0].x, cells.robot), along(poses[0].y, cells.robot)};
  for (std::size_t k = 0; k < kObjects.size(); ++k) {
    const Pose& p = poses[kObjects[k]];
    const double period = 2.0 * kPi / kOrders[k];
    const double slots = std::max(1.0, std::round(period / cells.object));
    double share = std::fmod(p.theta / period, 1.0);
    if (share < 0.0) share += 1.0;
    cell.push_back(along(p.x, cells.object));
    cell.push_back(along(p.y, cells.object));
    cell.push_back(std::lround(std::floor(share * slots + cells.shift)) % std::lround(slots));
  }
  return cell;
}

TEST(StateMetricCell, NamesAreOneToOneWithNaiveCells) {
  const StateMetric metric(mixed_scene());
  Rng rng(7);
  for (const StateMetric::Cells& cells :
       {StateMetric::Cells{}, StateMetric::Cells{1.3, 0.9, 0.4}, StateMetric::Cells{5, 20, 0.75}}) {
    std::map<std::vector<long>, std::uint64_t> names;
    std::map<std::uint64_t, std::vector<long>> cells_of;
    for (int trial = 0; trial < 5000; ++trial) {
      const Poses poses = random_poses(rng);
      const std::vector<long> naive = naive_cell(poses, cells);
      const std::uint64_t name = metric.cell(poses, cells);
      ASSERT_EQ(names.emplace(naive, name).first->second, name);
      ASSERT_EQ(cells_of.emplace(name, naive).first->second, naive);
    }
  }
}

TEST(StateMetricCell, ShiftMovesTheGridByAShareOfACell) {
  const StateMetric metric(mixed_scene());
  Poses left(5, {0.2, 0.2, 0.2}), right = left;
  left[1].x = -0.1;  // a line of the grid lies between them at 0, and none of the shifted one
  right[1].x = 0.1;
  EXPECT_NE(metric.cell(left, {0.8, 0.4, 0.0}), metric.cell(right, {0.8, 0.4, 0.0}));
  EXPECT_EQ(metric.cell(left, {0.8, 0.4, 0.5}), metric.cell(right, {0.8, 0.4, 0.5}));
  right[1].x = 0.21;  // beyond the shifted line at 0.2
  EXPECT_NE(metric.cell(left, {0.8, 0.4, 0.5}), metric.cell(right, {0.8, 0.4, 0.5}));
}

TEST(StateMetricCell, LinesOfTheRobotAreItsOwn) {
  const StateMetric metric(mixed_scene());
  Poses a(5, {0.1, 0.1, 0.1}), b = a;
  b[0] = {0.7, 0.7, 3.0};
  EXPECT_EQ(metric.cell(a, {0.8, 0.4, 0.0}), metric.cell(b, {0.8, 0.4, 0.0}));
  EXPECT_NE(metric.cell(a, {0.6, 0.4, 0.0}), metric.cell(b, {0.6, 0.4, 0.0}));
}

TEST(StateMetricCell, AnglesGoRoundWithThePeriodOfTheShape) {
  const StateMetric metric(mixed_scene());
  Rng rng(8);
  Poses a(5, {0.1, 0.1, 0.05});
  for (const double shift : {0.0, 0.5}) {
    const StateMetric::Cells cells{0.8, 0.4, shift};
    for (int trial = 0; trial < 50; ++trial)
      EXPECT_EQ(metric.cell(look_alike(a, rng), cells), metric.cell(a, cells));
  }
  Poses below = a;
  below[1].theta = -0.05;  // across the line at 0, in one cell of the grid moved by half a cell
  EXPECT_NE(metric.cell(below, {0.8, 0.4, 0.0}), metric.cell(a, {0.8, 0.4, 0.0}));
  EXPECT_EQ(metric.cell(below, {0.8, 0.4, 0.5}), metric.cell(a, {0.8, 0.4, 0.5}));
}

}  // namespace
}  // namespace rtg
