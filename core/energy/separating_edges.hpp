#pragma once

#include <numbers>

#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// Half of a separating-axis test: the edges of one body against the vertices of another. It uses
/// the same distances to the edge lines ("planes") as the gaps.
///
/// The test permits an overlap of 4 ln 2/α:
///
/// - 2 ln 2/α for corners, which the smoothed distance cuts off;
/// - 2 ln 2/α for acute tips. Two tips can overlap although no vertex is inside the other body. No
///   contact force then grows before the test fails, and solvers would get stuck.
///
/// Departs from the paper: it tests vertices alone (P_⊥). Two crossed bars pass that.
template <class T>
class SeparatingEdges {
 public:
  /// `edges` is the number of edges of the polygon in each lane, 0 of a single point. Further
  /// entries of `planes` are unused.
  SeparatingEdges(const Planes<T>& planes, const T& edges) : planes_(planes), edges_(edges) {
    for (int k = 0; k < planes.count; ++k) least_[k] = T(INFINITY);
  }

  /// Records the `distances` of a vertex to the planes, in the lanes `real` that have this vertex.
  void note(const T* distances, const Mask<T>& real) {
    for (int k = 0; k < planes_.count; ++k)
      least_[k] = select(real, lesser(least_[k], distances[k]), least_[k]);
  }

  /// Returns the lanes in which an edge separates the two bodies, or in which there is none: of a
  /// single point the gap tells enough. Call note() for all vertices first. `sharpness` is α.
  Mask<T> separate(double sharpness) const {
    T best(-INFINITY);
    for (int k = 0; k < planes_.count; ++k)
      best = select(edges_ > T(k), greater(best, least_[k]), best);
    return best > T(-kCorners * std::numbers::ln2 / sharpness) || edges_ == T(0.0);
  }

 private:
  static constexpr double kCorners = 4.0;  // permitted overlap in units of ln 2/α

  const Planes<T>& planes_;
  const T& edges_;
  T least_[kMaxVertices];  // per plane: least distance of the vertices [m]
};

}  // namespace rtg::energy
