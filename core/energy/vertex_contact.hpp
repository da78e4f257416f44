#pragma once

#include "core/energy/scene_model.hpp"

namespace rtg::energy {

/// Least ratio of a small gap to its previous value that a line search accepts. A gap is small
/// below this fraction of the barrier's range ĝ. See is_gap_acceptable().
inline constexpr double kMinGapRatio = 0.1;

/// Returns whether a line search may accept `gap`. It must be positive, and at least the smaller of
/// kMinGapRatio ĝ and kMinGapRatio times `previous_gap`.
template <class T>
Mask<T> is_gap_acceptable(const T& gap, const T& previous_gap, const Barrier& barrier) {
  return gap > T(0.0) &&
         !(gap < T(kMinGapRatio * barrier.range) && gap < T(kMinGapRatio) * previous_gap);
}

/// A vertex of the first body of a pair, with its distances to the edge lines of the second.
template <class T>
struct VertexContact {
  ContactPoint<T> point;
  Mask<T> within;  // lanes in which the gap may be below the barrier's range

  VertexContact(const SceneModel<T>& scene, int pair, int vertex, const PairFrame<T>& frame,
                const Mask<T>& near)
      : point(scene.point(pair, vertex, frame)), scene_(scene), planes_(scene.planes(pair)) {
    top_ = plane_distances(planes_, point.x, distances);
    within = near && scene.is_tip(pair, vertex);
    if (scene.is_rounded()) rounding_ = scene.rounding(pair);
    if (!scene.barrier().plain)
      within = within && top_ < T(scene.barrier().range + scene.skin()) + rounding_;
  }

  /// Computes the signed distance of the vertex. This is costly: call it only if any(within).
  SignedDistance<T> distance() const {
    SignedDistance<T> d{planes_, scene_.sharpness(), distances, top_};
    const Mask<T> round = rounding_ > T(0.0);
    if (any(round)) d.make_exact(round, point.x, top_);
    return d;
  }
  /// Returns the gap in the lanes `where`, and far() in the others. That of round corners is
  /// smaller than the distance of their centres by their radii.
  T gap(const SignedDistance<T>& d, const Mask<T>& where) const {
    return select(where, d.value - rounding_ - T(scene_.skin()), far(scene_));
  }
  /// Returns 2 ĝ, the gap that stands for "beyond the barrier's range" [m].
  static T far(const SceneModel<T>& scene) { return T(2.0 * scene.barrier().range); }
  T gap() const { return any(within) ? gap(distance(), within) : far(scene_); }

  T distances[kMaxVertices];  // to the edge lines [m]

 private:
  const SceneModel<T>& scene_;
  const Planes<T>& planes_;
  T top_;
  T rounding_{0.0};  // sum of both radii [m]
};

}  // namespace rtg::energy
