#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/scene.hpp"

namespace rtg {

/// Largest k such that turning the shape about its origin by 2π/k maps it onto itself.
int symmetry_order(const Polygon& shape);

/// a - b modulo the period 2π/order, in [-π/order, π/order] [rad].
double angle_difference(double a, double b, int order);

/// How far apart two states of a scene are: Euclidean distance of their embeddings
///
///   robot (x, y),  per movable object  w·(x, y, (r/k) cos kθ, (r/k) sin kθ),
///
/// k the symmetry order of the object (1 with a joint), so that poses which look the same are the
/// same point. The robot's heading is held by every push and does not count; fixed bodies do not
/// move.
class StateMetric {
 public:
  explicit StateMetric(const Scene& scene);

  /// Numbers per embedded state.
  int size() const { return 2 + 4 * static_cast<int>(objects_.size()); }

  /// Writes size() numbers.
  void embed(const Poses& poses, std::span<float> out) const;

  /// Weighted distance [m].
  double distance(const Poses& a, const Poses& b) const;

  /// Sum over the objects of the distance of their positions plus r · angle difference [m].
  double layout_distance(const Poses& a, const Poses& b) const;

  /// Largest |Δx|, |Δy| of an object [m] and largest angle difference [rad].
  struct Spread {
    double position = 0.0, angle = 0.0;
  };
  Spread spread(const Poses& a, const Poses& b) const;

  /// Whether all are within `tolerance` of each other: x and y [m], the objects' angles [rad].
  bool within(const Poses& a, const Poses& b, double tolerance) const;

  /// Name of the cell that a state lies in, cells of side `robot` for the robot's x, y and of side
  /// `object` for the objects' x, y [m] and angle [rad] (rounded to a whole number of cells per
  /// period); `shift` in [0, 1) moves the grid by that share of a cell.
  struct Cells {
    double robot = 0.8, object = 0.4, shift = 0.0;
  };
  std::uint64_t cell(const Poses& poses, const Cells& cells) const;

  /// Bodies other than the robot that can move.
  struct Object {
    std::size_t body;
    int order;
  };
  std::span<const Object> objects() const { return objects_; }

 private:
  std::vector<Object> objects_;
};

}  // namespace rtg
