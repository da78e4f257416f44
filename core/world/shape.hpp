#pragma once

#include <span>
#include <vector>

#include "core/world/polygon.hpp"

namespace rtg {

/// A convex part of a shape: all points within `radius` of the polygon `core`. Its corners are
/// round if the radius is not zero. A core of a single vertex makes a disc.
struct Part {
  Polygon core;         // in the body frame [m]
  double radius = 0.0;  // [m]

  bool operator==(const Part&) const = default;
  bool is_disc() const { return core.size() == 1; }
};

/// Returns the largest distance of a point of `part` from `point` [m].
double reach_from(const Vector2d& point, const Part& part);

/// Returns a disc around the origin of the body frame.
Part disc(double radius);

/// The shape of a rigid body: the union of convex parts, which may overlap.
///
/// Its mass properties are exact for one part. Those of several parts are the ones of their union
/// (core/world/outline.hpp), whose round corners are polygons of 512 sides per turn there.
class Shape {
 public:
  Shape() = default;
  Shape(Polygon polygon);  // one convex part; implicit, as a polygon is a shape
  Shape(Part part);
  explicit Shape(std::vector<Part> parts);

  bool operator==(const Shape& other) const { return parts_ == other.parts_; }

  const std::vector<Part>& parts() const { return parts_; }
  /// Returns the area integrals of the union.
  const Moments& moments() const { return moments_; }
  /// Returns the largest distance of a point of the shape from the origin of the body frame [m].
  double radius() const { return radius_; }
  /// Returns the least turn about the origin that maps the shape onto itself [rad]: 2π if there is
  /// no smaller one. Returns 0 for a disc, which every turn maps onto itself.
  double symmetry() const { return symmetry_; }
  /// Returns the union as convex polygons that do not overlap (disjoint_pieces()).
  const std::vector<Polygon>& pieces() const { return pieces_; }
  /// Returns the same shape with its centroid at the origin.
  Shape centred() const;
  /// Returns the vertices of the core of a part that can touch other bodies: those that are convex
  /// corners of the union, each in one part alone.
  const std::vector<std::size_t>& tips(std::size_t part) const { return tips_[part]; }

 private:
  std::vector<Part> parts_;
  Moments moments_;
  double radius_ = 0.0, symmetry_ = 0.0;
  std::vector<Polygon> pieces_;
  std::vector<std::vector<std::size_t>> tips_;  // per part
};

/// Returns the parts moved by `by` and turned by `angle` about the origin before.
std::vector<Part> placed(std::vector<Part> parts, double angle, const Vector2d& by);

}  // namespace rtg
