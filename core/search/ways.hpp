#pragma once

#include <vector>

#include "core/world/scene.hpp"

namespace rtg::search {

/// Shortest ways of a point around some bodies of a scene, each widened by a clearance:
/// straight lines where nothing is in between, else along the corners of a visibility graph
/// [Lozano-Pérez and Wesley 1979].
class Ways {
 public:
  /// Without obstacles: all ways are straight.
  Ways() = default;

  /// The bodies with the indices `obstacles` at their `poses`, widened by `clearance` [m]. Corners
  /// with |x| or |y| above `arena` [m] lie on no way.
  Ways(const Scene& scene, const Poses& poses, const std::vector<std::size_t>& obstacles,
       double clearance, double arena);

  struct Way {
    double length = 0.0;               // [m]
    Vector2d next = Vector2d::Zero();  // where its first straight piece ends
  };

  /// Returns the shortest way from `a` to `b`. A way enters an obstacle no deeper than its ends
  /// lie in it. If there is no way, returns the straight one, longer by the width of the arena.
  Way between(const Vector2d& a, const Vector2d& b) const;

 private:
  struct Obstacle {  // convex
    std::vector<Vector2d> vertices;
    std::vector<Vector2d> normals;  // of the edge that begins at each vertex
  };
  struct Point {
    Vector2d x;
    std::vector<double> depths;  // how deep it lies in each obstacle, 0 outside [m]
  };

  static double depth(const Obstacle& obstacle, const Vector2d& x);
  static bool enters(const Obstacle& obstacle, const Vector2d& a, const Vector2d& b, double free);
  Point point(const Vector2d& x) const;
  bool is_free(const Point& a, const Point& b) const;
  std::vector<std::pair<std::size_t, double>> seen_from(const Point& point) const;

  std::vector<Obstacle> obstacles_;
  std::vector<Point> corners_;
  MatrixXd lengths_;  // of the ways between corners; infinite if there is none
  double arena_ = 0.0;
};

/// Returns half the least width of a shape between two parallel lines, to 1 % [m]: what a body
/// needs on each side of its centre to pass a gap.
double least_half_width(const Shape& shape);

}  // namespace rtg::search
