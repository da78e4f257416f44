#include "core/world/signed_distance.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/math/rng.hpp"

namespace rtg {
namespace {

constexpr double kAlpha = 50.0;

double distance(const HalfPlanes& planes, const Vector2d& x) {
  return signed_distance(planes, kAlpha, x).value;
}

TEST(SignedDistance, HalfPlanesHaveUnitNormals) {
  for (const Polygon& shape : {box(1.2, 1.2), box(0.4, 3.0), regular_polygon(6, 0.8)}) {
    const HalfPlanes planes = half_planes(shape);
    for (int k = 0; k < planes.count; ++k) {
      EXPECT_NEAR(planes.normal[k].norm(), 1.0, 1e-15);
      for (const Vector2d& v : shape.vertices)
        EXPECT_LE(planes.normal[k].dot(v), planes.offset[k] + 1e-15);
    }
  }
}

TEST(SignedDistance, IsExactOnFaces) {
  const HalfPlanes square = half_planes(box(1.2, 1.2));
  EXPECT_NEAR(distance(square, {0.7, 0.1}), 0.1, 1e-8);
  EXPECT_NEAR(distance(square, {-0.2, -0.9}), 0.3, 1e-8);
}

TEST(SignedDistance, CutsCornersByTheKnownLength) {
  const HalfPlanes square = half_planes(box(1.2, 1.2));
  const double cut = std::numbers::sqrt2 * std::numbers::ln2 / kAlpha;  // along the bisector
  const Vector2d tip = Vector2d::Constant(0.6 - cut / std::numbers::sqrt2);
  EXPECT_NEAR(distance(square, tip), 0.0, 1e-12);
}

template <class Distance>
void expect_derivatives(Distance distance_at, const Vector2d& x, const Vector2d& along) {
  const double t = 1e-6;
  const SignedDistance<double> d = distance_at(x);
  const SignedDistance<double> up = distance_at(x + t * along), down = distance_at(x - t * along);
  EXPECT_NEAR(d.gradient.dot(along), (up.value - down.value) / (2.0 * t), 1e-8);
  EXPECT_LT((d.hessian() * along - (up.gradient - down.gradient) / (2.0 * t)).norm(), 1e-6);
  EXPECT_LT((d.third(along) - (up.hessian() - down.hessian()) / (2.0 * t)).norm(), 1e-4);
}

// Anywhere and at a corner, along random directions and along the gradient, where errors do not
// average out.
TEST(SignedDistance, DerivativesMatchDifferences) {
  const HalfPlanes hexagon = half_planes(regular_polygon(6, 0.8));
  const auto at = [&](const Vector2d& x) { return signed_distance(hexagon, kAlpha, x); };
  Rng rng(3);
  const Vector2d corner(0.8, 0.0);
  for (int trial = 0; trial < 20; ++trial) {
    const double reach = trial % 2 == 0 ? 1.0 : 0.02;
    const Vector2d off(rng.uniform(-reach, reach), rng.uniform(-reach, reach));
    const Vector2d x = trial % 2 == 0 ? off : Vector2d(corner + off);
    expect_derivatives(at, x, {rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)});
    expect_derivatives(at, x, at(x).gradient);
  }
}

TEST(ExactDistance, IsThatFromTheNearestEdgeOrCorner) {
  const HalfPlanes square = half_planes(box(2, 2));
  EXPECT_NEAR(exact_distance(square, {1.5, 0.3}).value, 0.5, 1e-15);
  EXPECT_NEAR(exact_distance(square, {1.3, 1.4}).value, 0.5, 1e-15);
  EXPECT_NEAR(exact_distance(square, {0.9, 0.2}).value, -0.1, 1e-15);  // inside
  const HalfPlanes point = half_planes({{{0.5, 0.0}}});
  EXPECT_NEAR(exact_distance(point, {0.5, -0.3}).value, 0.3, 1e-15);
}

TEST(ExactDistance, DerivativesMatchDifferences) {
  const HalfPlanes square = half_planes(box(2, 2)), point = half_planes({{{0.5, 0.0}}});
  Rng rng(4);
  for (const Vector2d& x : {Vector2d(1.3, 1.4), Vector2d(-1.2, 0.3), Vector2d(-0.2, -1.1)})
    for (const HalfPlanes* planes : {&square, &point}) {
      const auto at = [&](const Vector2d& y) { return exact_distance(*planes, y); };
      expect_derivatives(at, x, {rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)});
      expect_derivatives(at, x, at(x).gradient);
    }
}

}  // namespace
}  // namespace rtg
