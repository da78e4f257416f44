#pragma once

#include <vector>

#include "core/energy/placement.hpp"
#include "core/world/scene.hpp"
#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// A revolute joint, t_i + R_i a = t_j + R_j b with the angle φ = θ_j - θ_i within its limits.
template <class T>
struct Hinge {
  int parent = 0, child = 0;  // i, j
  Vec2<T> a, b;               // the pin in the frames of parent and child [m]
  T lower, upper;             // limits of φ [rad]; infinite if there is none
  T reach;                    // largest distance of a child's vertex from the pin [m]
};

/// The reduced coordinates q of scenes with joints: the poses of the root bodies and the angles of
/// all other bodies. They are entries of the poses p. In reduced coordinates joints never open.
/// p(q) is computed hinge by hinge, from the roots to the leaves,
///
///   t_j = t_i + R_i a - R_j b,   ∂t_j/∂θ_i = E R_i a,   ∂t_j/∂θ_j = -E R_j b,
///
/// and J = ∂p/∂q is the product of these steps. Forces and rows of matrices are transformed from
/// the leaves to the roots. The entries x, y of a child's block belong to no coordinate; they are
/// zero in vectors over q.
template <class T>
class Articulation {
 public:
  Articulation() = default;
  /// `scene` must list its movable bodies first.
  explicit Articulation(const Scene& scene);
  /// Returns an articulation with the hinges of `like` but without their geometry, which load()
  /// fills in.
  template <class U>
  static Articulation room_for(const Articulation<U>& like);
  void load(int lane, const Articulation<double>& one);
  /// Removes all limits in this lane.
  void unload(int lane);

  bool empty() const { return hinges_.empty(); }
  /// Parents before children.
  const std::vector<Hinge<T>>& hinges() const { return hinges_; }
  bool movable(int body) const { return body < movable_; }

  /// p ← p(q).
  void close(Placement<T>& at) const;
  /// y ← J y [3·movable]: converts motions (or multipliers) of the coordinates to those of all
  /// bodies.
  void spread(const Placement<T>& at, T* y) const;
  /// g ← Jᵀ g [3·movable]: converts forces on the bodies to those on the coordinates.
  void gather(const Placement<T>& at, T* g) const;

 private:
  template <class U>
  friend class Articulation;

  int movable_ = 0;
  std::vector<Hinge<T>> hinges_;
};

/// R v.
template <class T>
Vec2<T> turned_by(const Turn<T>& turn, const Vec2<T>& v) {
  return {turn.c * v.x() - turn.s * v.y(), turn.s * v.x() + turn.c * v.y()};
}

/// The vectors from the centres of the two bodies to the pin of their hinge, in the world frame.
template <class T>
struct Arms {
  Vec2<T> a, b;  // R_i a, R_j b [m]

  Arms(const Hinge<T>& hinge, const Placement<T>& at)
      : a(turned_by(at.turns[static_cast<std::size_t>(hinge.parent)], hinge.a)),
        b(turned_by(at.turns[static_cast<std::size_t>(hinge.child)], hinge.b)) {}
};

}  // namespace rtg::energy
