#pragma once

#include "core/energy/scene_model.hpp"

namespace rtg::energy {

/// Share of the barrier's range below which a trial point must leave a gap that share of what it
/// was.
inline constexpr double kKeptGap = 0.1;

template <class T>
Mask<T> keeps_gap(const T& gap, const T& was, const Barrier& barrier) {
  return gap > T(0.0) && !(gap < T(kKeptGap * barrier.range) && gap < T(kKeptGap) * was);
}

/// A vertex beside another body: its place and the distances to the body's planes.
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

  /// To be asked for where some lane is within.
  SignedDistance<T> distance() const { return {planes_, scene_.sharpness(), distances, top_}; }
  /// The gap where the mask says so, 2 ĝ elsewhere.
  T gap(const SignedDistance<T>& d, const Mask<T>& where) const {
    return select(where, d.value - T(scene_.skin()), far(scene_));
  }
  static T far(const SceneModel<T>& scene) { return T(2.0 * scene.barrier().range); }
  T gap() const { return any(within) ? gap(distance(), within) : far(scene_); }

  T distances[kMaxVertices];  // to the planes

 private:
  const SceneModel<T>& scene_;
  const Planes<T>& planes_;
  T top_;
};

}  // namespace rtg::energy
