#pragma once

#include <vector>

#include "core/energy/placement.hpp"
#include "core/world/scene.hpp"
#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// Returns which of a child's three entries in a vector over the coordinates belongs to its
/// coordinate: 2 (θ_j), 0 (s), or -1 if it has none.
constexpr int slot_of(JointType type) {
  return type == JointType::kRevolute ? 2 : type == JointType::kPrismatic ? 0 : -1;
}

/// A joint (rtg::Joint), in each lane of T with a geometry of its own.
template <class T>
struct JointModel {
  int parent = 0, child = 0;  // i, j
  JointType type = JointType::kRevolute;
  Vec2<T> a, b;    // the pins in the frames of parent and child [m]
  Vec2<T> axis;    // u
  T angle;         // α [rad]
  T lower, upper;  // limits of the value; infinite if there is none
  T reach;         // way of the child's farthest vertex per unit of the value [m/rad], or 1

  bool is_revolute() const { return type == JointType::kRevolute; }
};

/// Reduced coordinates q of a scene with joints, in which joints cannot open. q consists of the
/// poses of the root bodies, which are no joint's child, and of a coordinate for each other body:
/// its angle θ_j if its joint is revolute, the value s if it is prismatic, none if it is fixed. The
/// poses p(q) follow joint by joint, from the roots to the leaves. J = ∂p/∂q is the product of
/// their JointSteps. Forces and rows of matrices are transformed by Jᵀ, from the leaves to the
/// roots.
///
/// Vectors over q have the layout of p [3·movable]. Of a child's three entries the third belongs to
/// θ_j, the first to s. The others belong to no coordinate and are zero.
///
/// Departs from the paper: it does not say how it holds joints together. Here no term is added to
/// Ψ, joints never open, and the Newton systems get smaller.
template <class T>
class Articulation {
 public:
  Articulation() = default;
  /// `scene` must list its movable bodies first.
  explicit Articulation(const Scene& scene);
  /// Returns an articulation with the same joints as `like`. load() then sets their geometry, lane
  /// by lane (core/math/lanes.hpp).
  template <class U>
  static Articulation room_for(const Articulation<U>& like);
  /// Copies the geometry of `one` into this lane.
  void load(int lane, const Articulation<double>& one);
  /// Removes all limits in this lane.
  void unload(int lane);

  bool empty() const { return joints_.empty(); }
  /// Returns the joints in an order from the roots to the leaves.
  const std::vector<JointModel<T>>& joints() const { return joints_; }
  bool movable(int body) const { return body < movable_; }

  /// Moves each child to the pose nearest to its own at which its joint closes.
  void close(Placement<T>& at) const;
  /// Sets the children in `to` to p(q + `length` `step`), q being the coordinates of `from`. In
  /// `to` the roots and the coordinates θ_j have moved already.
  void follow(const Placement<T>& from, const T* step, const T& length, Placement<T>& to) const;
  /// y ← J y [3·movable]: converts a motion in the coordinates q to the motion of all bodies.
  /// Multipliers transform in the same way.
  void apply_jacobian(const Placement<T>& at, T* y) const;
  /// Reverses apply_jacobian().
  void to_coordinates(const Placement<T>& at, T* w) const;
  /// g ← Jᵀ g [3·movable]: converts forces on the bodies to generalised forces on q. Adds those of
  /// `at_joints`, one per joint, which act on its value; none if null.
  void apply_jacobian_transposed(const Placement<T>& at, T* g, const T* at_joints = nullptr) const;

 private:
  template <class U>
  friend class Articulation;
  void set_child(const JointModel<T>& joint, const T& value, Placement<T>& at) const;

  int movable_ = 0;
  std::vector<JointModel<T>> joints_;
};

/// Returns R v, with `turn` the rotation R.
template <class T>
Vec2<T> turned_by(const Turn<T>& turn, const Vec2<T>& v) {
  return {turn.c * v.x() - turn.s * v.y(), turn.s * v.x() + turn.c * v.y()};
}

/// Returns the value of a joint, φ [rad] or s [m].
template <class T>
T value_of(const JointModel<T>& joint, const Placement<T>& at) {
  const T *parent = at.body(joint.parent), *child = at.body(joint.child);
  if (joint.is_revolute()) return child[2] - parent[2];
  if (joint.type == JointType::kFixed) return T(0.0);
  const Turn<T>& turn = at.turns[static_cast<std::size_t>(joint.parent)];
  const Vec2<T> a = turned_by(turn, joint.a), axis = turned_by(turn, joint.axis);
  const Vec2<T> b = turned_by(at.turns[static_cast<std::size_t>(joint.child)], joint.b);
  return axis.x() * (child[0] + b.x() - parent[0] - a.x()) +
         axis.y() * (child[1] + b.y() - parent[1] - a.y());
}

}  // namespace rtg::energy
