#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/scene.hpp"

namespace rtg::search {

/// Returns the largest k such that turning the shape about its origin by 2π/k maps it onto itself.
int symmetry_order(const Polygon& shape);

/// Returns a - b modulo the period 2π/order, in [-π/order, π/order] [rad].
double angle_difference(double a, double b, int order);

/// Compares states of a scene modulo the symmetry of each object (order 1 with a joint), so that
/// poses that look the same count as equal. The robot's heading does not count, as every push holds
/// it; nor do fixed bodies.
class StateMetric {
 public:
  explicit StateMetric(const Scene& scene);

  /// A body other than the robot that can move.
  struct Object {
    std::size_t body;
    bool jointed;
    int order;
  };
  std::span<const Object> objects() const { return objects_; }

  /// Returns the distance between an object's positions plus r · its angle difference [m].
  double distance(const Object& object, const Poses& a, const Poses& b) const;

  /// Returns the sum of distance() over all objects.
  double layout_distance(const Poses& a, const Poses& b) const;

  /// Returns the key of the cell in which a state lies. A cell measures 0.8 m in the robot's x and
  /// y, 0.4 m in an object's x and y, and about 0.4 rad in an object's angle (a whole number of
  /// cells per period).
  std::uint64_t cell(const Poses& poses) const;

  /// Returns the key of the cell without the robot's coordinates.
  std::uint64_t layout_cell(const Poses& poses) const;

 private:
  std::vector<Object> objects_;
};

}  // namespace rtg::search
