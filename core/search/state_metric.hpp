#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/scene.hpp"

namespace rtg::search {

/// Largest k such that turning the shape about its origin by 2π/k maps it onto itself.
int symmetry_order(const Polygon& shape);

/// a - b modulo the period 2π/order, in [-π/order, π/order] [rad].
double angle_difference(double a, double b, int order);

/// Compares states of a scene modulo the symmetry order of each object (1 with a joint), so that
/// poses which look the same are the same. The robot's heading is held by every push and does not
/// count; fixed bodies do not move.
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

  /// Distance of an object's positions plus r · angle difference [m].
  double distance(const Object& object, const Poses& a, const Poses& b) const;

  /// The same, summed over the objects.
  double layout_distance(const Poses& a, const Poses& b) const;

  /// Names the cell that a state lies in: cells of 0.8 m for the robot's x, y and of 0.4 m and
  /// about 0.4 rad (a whole number per period) for the objects.
  std::uint64_t cell(const Poses& poses) const;

  /// Names the cell without the robot.
  std::uint64_t layout_cell(const Poses& poses) const;

 private:
  std::vector<Object> objects_;
};

}  // namespace rtg::search
