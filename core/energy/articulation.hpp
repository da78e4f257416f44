#pragma once

#include <vector>

#include "core/energy/placement.hpp"
#include "core/world/scene.hpp"
#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// A revolute joint between a parent body i and a child body j: t_i + R_i a = t_j + R_j b. t and R
/// are the position and the rotation of a body. The joint angle is φ = θ_j - θ_i.
template <class T>
struct Hinge {
  int parent = 0, child = 0;  // i, j
  Vec2<T> a, b;               // the pin in the frames of parent and child [m]
  T lower, upper;             // limits of φ [rad]; infinite if there is none
  T reach;                    // largest distance of a child's vertex from the pin [m]
};

/// Reduced coordinates q of a scene with joints, in which joints cannot open. q consists of the
/// poses of the root bodies, which are no joint's child, and of the angles of all other bodies. The
/// poses p(q) follow hinge by hinge, from the roots to the leaves:
///
///   t_j = t_i + R_i a - R_j b,   ∂t_j/∂θ_i = E R_i a,   ∂t_j/∂θ_j = -E R_j b.
///
/// J = ∂p/∂q is the product of these steps. Forces and rows of matrices are transformed by Jᵀ, from
/// the leaves to the roots.
///
/// Vectors over q have the layout of p [3·movable]. A child's entries for x and y belong to no
/// coordinate and are zero.
///
/// Departs from the paper: it does not say how it holds joints together. Here no term is added to
/// Ψ, joints never open, and the Newton systems get smaller.
template <class T>
class Articulation {
 public:
  Articulation() = default;
  /// `scene` must list its movable bodies first.
  explicit Articulation(const Scene& scene);
  /// Returns an articulation with the same hinges as `like`. load() then sets their geometry, lane
  /// by lane (core/math/lanes.hpp).
  template <class U>
  static Articulation room_for(const Articulation<U>& like);
  /// Copies the geometry of `one` into this lane.
  void load(int lane, const Articulation<double>& one);
  /// Removes all limits in this lane.
  void unload(int lane);

  bool empty() const { return hinges_.empty(); }
  /// Returns the hinges in an order from the roots to the leaves.
  const std::vector<Hinge<T>>& hinges() const { return hinges_; }
  bool movable(int body) const { return body < movable_; }

  /// p ← p(q): moves each child to where its hinge closes.
  void close(Placement<T>& at) const;
  /// y ← J y [3·movable]: converts a motion in the coordinates q to the motion of all bodies.
  /// Multipliers transform in the same way.
  void apply_jacobian(const Placement<T>& at, T* y) const;
  /// g ← Jᵀ g [3·movable]: converts forces on the bodies to generalised forces on q.
  void apply_jacobian_transposed(const Placement<T>& at, T* g) const;

 private:
  template <class U>
  friend class Articulation;

  int movable_ = 0;
  std::vector<Hinge<T>> hinges_;
};

/// Returns R v, with `turn` the rotation R.
template <class T>
Vec2<T> turned_by(const Turn<T>& turn, const Vec2<T>& v) {
  return {turn.c * v.x() - turn.s * v.y(), turn.s * v.x() + turn.c * v.y()};
}

/// The vectors from the two bodies' centres to the pin of their hinge, in the world frame.
template <class T>
struct Arms {
  Vec2<T> a, b;  // R_i a, R_j b [m]

  Arms(const Hinge<T>& hinge, const Placement<T>& at)
      : a(turned_by(at.turns[static_cast<std::size_t>(hinge.parent)], hinge.a)),
        b(turned_by(at.turns[static_cast<std::size_t>(hinge.child)], hinge.b)) {}
};

}  // namespace rtg::energy
