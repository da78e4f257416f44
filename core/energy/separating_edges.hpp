#pragma once

#include <numbers>

#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// A direction of the separating-axis test: the edges of one body against the vertices of another.
/// It uses the same distances to the planes as the gaps.
///
/// The test permits an overlap of 4 ln 2/α. The first 2 ln 2/α are for corners, which the smoothed
/// distance cuts. The rest is for acute tips, which can pass each other with no vertex inside the
/// other body: there no contact force grows before the test fails, and this would stop every
/// solver.
template <class T>
class SeparatingEdges {
 public:
  /// `edges` is the number of edges of the polygon in each lane; further planes are unused.
  SeparatingEdges(const Planes<T>& planes, const T& edges) : planes_(planes), edges_(edges) {
    for (int k = 0; k < planes.count; ++k) least_[k] = T(INFINITY);
  }

  /// Takes the plane distances of a vertex into account in the lanes `real`, those that have it.
  void note(const T* distances, const Mask<T>& real) {
    for (int k = 0; k < planes_.count; ++k)
      least_[k] = select(real, lesser(least_[k], distances[k]), least_[k]);
  }

  /// Returns whether one of the planes separates the two bodies. Call note() for all vertices
  /// first.
  Mask<T> separate(double sharpness) const {
    T best(-INFINITY);
    for (int k = 0; k < planes_.count; ++k)
      best = select(edges_ > T(k), greater(best, least_[k]), best);
    return best > T(-kCorners * std::numbers::ln2 / sharpness);
  }

 private:
  static constexpr double kCorners = 4.0;  // permitted overlap in units of ln 2/α

  const Planes<T>& planes_;
  const T& edges_;
  T least_[kMaxVertices];  // per plane: least distance of the vertices [m]
};

}  // namespace rtg::energy
