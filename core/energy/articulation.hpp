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
  T lower, upper;             // of φ [rad]; infinite: none
  T reach;                    // of the child from the pin [m]
};

/// The bodies of jointed scenes in reduced coordinates q: the poses of the roots and the angles of
/// all others, which are entries of the poses p. So joints never open. p(q) follows the hinges,
///
///   t_j = t_i + R_i a - R_j b,   ∂t_j/∂θ_i = E R_i a,   ∂t_j/∂θ_j = -E R_j b,
///
/// from the roots on, forces and rows of matrices back from the leaves, one hinge at a time:
/// J = ∂p/∂q is the product of these steps. Where a body is jointed, the entries x, y of its block
/// belong to no coordinate; they are zero in vectors over q.
template <class T>
class Articulation {
 public:
  Articulation() = default;
  /// `scene`: movable bodies first.
  explicit Articulation(const Scene& scene);
  /// Room for joints like those of `like`.
  template <class U>
  static Articulation room_for(const Articulation<U>& like);
  void load(int lane, const Articulation<double>& one);
  /// No limits in that lane.
  void unload(int lane);

  bool empty() const { return hinges_.empty(); }
  /// Parents before children.
  const std::vector<Hinge<T>>& hinges() const { return hinges_; }
  bool movable(int body) const { return body < movable_; }

  /// p ← p(q).
  void close(Placement<T>& at) const;
  /// y ← J y: of motions (or multipliers) of the coordinates, those of all bodies [3·movable].
  void spread(const Placement<T>& at, T* y) const;
  /// g ← Jᵀ g: of forces on the bodies, those on the coordinates [3·movable].
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

/// The pin of a hinge as seen from the two centres, in the world frame.
template <class T>
struct Arms {
  Vec2<T> a, b;  // R_i a, R_j b [m]

  Arms(const Hinge<T>& hinge, const Placement<T>& at)
      : a(turned_by(at.turns[static_cast<std::size_t>(hinge.parent)], hinge.a)),
        b(turned_by(at.turns[static_cast<std::size_t>(hinge.child)], hinge.b)) {}
};

}  // namespace rtg::energy
