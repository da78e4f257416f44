#pragma once

#include "core/energy/scene_model.hpp"

namespace rtg::energy {

/// Limit to the decrease of small gaps, as a share both of the barrier's range and of the gap's
/// previous value; see keeps_gap().
inline constexpr double kKeptGap = 0.1;

/// Returns whether a trial point has a legal gap: positive, and at least kKeptGap times the
/// barrier's range or kKeptGap times the previous value `was`.
template <class T>
Mask<T> keeps_gap(const T& gap, const T& was, const Barrier& barrier) {
  return gap > T(0.0) && !(gap < T(kKeptGap * barrier.range) && gap < T(kKeptGap) * was);
}

/// A vertex of one body and its distances to the planes of another body.
template <class T>
struct Touch {
  ContactPoint<T> point;
  Mask<T> within;  // where the gap may be less than the barrier's range

  Touch(const SceneModel<T>& scene, int pair, int vertex, const PairFrame<T>& frame,
        const Mask<T>& near)
      : point(scene.point(pair, vertex, frame)), scene_(scene), planes_(scene.planes(pair)) {
    top_ = plane_distances(planes_, point.x, distances);
    within = near && scene.real(pair, vertex);
    if (!scene.barrier().plain) within = within && top_ < T(scene.barrier().range + scene.skin());
  }

  /// Returns the signed distance of the vertex, which is costly: skip it if no lane is within.
  SignedDistance<T> distance() const { return {planes_, scene_.sharpness(), distances, top_}; }
  /// Returns the gap in the lanes `where`, 2 ĝ in the others.
  T gap(const SignedDistance<T>& d, const Mask<T>& where) const {
    return select(where, d.value - T(scene_.skin()), far(scene_));
  }
  static T far(const SceneModel<T>& scene) { return T(2.0 * scene.barrier().range); }
  T gap() const { return any(within) ? gap(distance(), within) : far(scene_); }

  T distances[kMaxVertices];  // to the planes [m]

 private:
  const SceneModel<T>& scene_;
  const Planes<T>& planes_;
  T top_;
};

}  // namespace rtg::energy
