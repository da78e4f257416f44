#pragma once

#include <numbers>

#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// A side of the separating-axis test, along with what measures the gaps: least distance of a
/// body's vertices to each plane of another. Corners, which the smoothed distance cuts, may overlap
/// by 2 ln 2/α, and by as much again: acute tips pass each other without a vertex in the other
/// body, and a wall there that no force announces would stop every solver.
template <class T>
class SeparatingEdges {
 public:
  /// `edges`: how many planes are real, by lane.
  SeparatingEdges(const Planes<T>& planes, const T& edges) : planes_(planes), edges_(edges) {
    for (int k = 0; k < planes.count; ++k) least_[k] = T(INFINITY);
  }

  /// Takes the plane distances of a vertex into account where it is real.
  void note(const T* distances, const Mask<T>& real) {
    for (int k = 0; k < planes_.count; ++k)
      least_[k] = select(real, lesser(least_[k], distances[k]), least_[k]);
  }

  /// Says whether, all vertices noted, one of the planes separates the two bodies.
  Mask<T> separate(double sharpness) const {
    T best(-INFINITY);
    for (int k = 0; k < planes_.count; ++k)
      best = select(edges_ > T(k), greater(best, least_[k]), best);
    return best > T(-kCorners * std::numbers::ln2 / sharpness);
  }

 private:
  static constexpr double kCorners = 4.0;

  const Planes<T>& planes_;
  const T& edges_;
  T least_[kMaxVertices];
};

}  // namespace rtg::energy
