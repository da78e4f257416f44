#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/math/rng.hpp"
#include "core/world/polygon.hpp"

namespace rtg::tasks {

/// |x - centre| ≤ radius.
struct Disc {
  Vector2d centre = Vector2d::Zero();
  double radius = 0.0;  // [m]

  bool operator==(const Disc&) const = default;
};

/// normal·x ≤ offset, |normal| = 1.
struct HalfPlane {
  Vector2d normal = Vector2d::UnitX();
  double offset = 0.0;  // [m]

  bool operator==(const HalfPlane&) const = default;
};

/// A region of the plane. A polygon is convex and counter-clockwise.
using Region = std::variant<Disc, HalfPlane, Polygon>;

/// Returns how far `x` lies outside the region [m]; negative or zero inside. Near a corner of a
/// polygon the distance from the nearest edge line counts.
double excess(const Region& region, const Vector2d& x);

/// Returns the region with its edge moved inwards by `by` [m]; outwards if that is negative.
Region inset(const Region& region, double by);

/// Returns the width that an inset can take away on each side [m]; infinite for a half-plane.
double half_width(const Region& region);

/// Moves `x` into the region. In a disc or a polygon the result is uniform and does not depend on
/// `x`. For a half-plane, `x` moves along the normal to a random distance behind the line, at most
/// its old distance. So points close to the line are likelier.
Vector2d moved_into(const Region& region, const Vector2d& x, Rng& rng);

/// Returns whether the region contains a point with |x|, |y| ≤ `a`. May return true for a polygon
/// that only comes near.
bool meets_square(const Region& region, double a);

/// Returns the vertices of the region as a polygon. A disc has 96. A half-plane is cut off `far`
/// [m] from the origin.
std::vector<Vector2d> ring_of(const Region& region, double far);

}  // namespace rtg::tasks
