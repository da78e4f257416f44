#pragma once

#include <array>
#include <vector>

#include "core/energy/articulation.hpp"
#include "core/energy/barrier.hpp"
#include "core/energy/contact_point.hpp"
#include "core/energy/damping.hpp"
#include "core/energy/inertia.hpp"
#include "core/energy/placement.hpp"
#include "core/energy/separating_edges.hpp"
#include "core/world/physics_config.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::energy {

/// Ordered pair of parts of two bodies. Its contacts are the tips of `part` against the edges of
/// `other_part`. The parts of all bodies are numbered one after another.
struct PartPair {
  int body = 0, other = 0;
  int part = 0, other_part = 0;
};

/// Returns the index of the contact of `vertex` in `pair`. Each pair owns kMaxVertices successive
/// indices. Those of the joint limits follow after all pairs.
inline int contact_of(int pair, int vertex) {
  return pair * static_cast<int>(kMaxVertices) + vertex;
}

/// The constants of a scene that energies and contacts depend on: shapes, masses, friction,
/// barrier. Energies are in units of k_D/Δt² (core/NOTATION.md).
///
/// Each lane (core/math/lanes.hpp) holds a scene of its own. All have the same number of bodies, of
/// movable bodies, and of parts of each body; the parts may differ.
template <class T>
class SceneModel {
 public:
  /// Loads `scene` into every lane. `scene` must list its movable bodies first; body 0 is the
  /// robot.
  SceneModel(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push);
  /// Returns a model with empty lanes and the physics constants of `like`. It is for scenes with as
  /// many bodies, movable bodies, and parts of each body as `like` and with joints between the same
  /// bodies.
  static SceneModel room_for(const SceneModel<double>& like) { return {like, Room{}}; }

  /// Copies the scene of `one` into this lane.
  void load(int lane, const SceneModel<double>& one);
  /// Empties this lane: its bodies have no contacts.
  void unload(int lane);

  int bodies() const { return bodies_; }
  /// Returns the number of parts of each body.
  const std::vector<int>& parts() const { return parts_; }
  int movable() const { return movable_; }
  bool movable(int body) const { return body < movable_; }
  /// Returns all ordered pairs of parts that can touch. For even n, pair n + 1 is pair n reversed.
  /// Those of two fixed bodies form no pair, nor do those of two bodies connected by a joint.
  const std::vector<PartPair>& pairs() const { return pairs_; }
  int pair_count() const { return static_cast<int>(pairs_.size()); }
  int contacts() const {
    return limit_contact(2 * static_cast<int>(articulation_.joints().size()));
  }
  int limit_contact(int limit) const { return contact_of(pair_count(), 0) + limit; }
  const Articulation<T>& articulation() const { return articulation_; }
  const Barrier& barrier() const { return barrier_; }
  double stride() const { return stride_; }  // of a sub-step [m]
  double sharpness() const { return sharpness_; }
  double slip() const { return slip_; }
  double skin() const { return skin_; }
  const Damping<T>& damping(int body) const { return damping_[body]; }
  /// Returns whether a sub-step depends on the one before it.
  bool inertial() const { return inertia_weight_ > 0.0; }
  /// Returns how far a free body coasts from push speed v: v Δt/k_D, in strides of a sub-step.
  /// Returns 0 without inertia.
  double coasting() const { return inertia_weight_; }
  Inertia<T> inertia(int body) const {
    const Damping<T>& d = damping_[body];
    return {d.mass * T(inertia_weight_), d.moment * T(inertia_weight_), d.periodic};
  }
  /// Returns the contribution of damping and inertia to Φ = ∂Ψ/∂p₊ for one body. `a` is the body's
  /// displacement (Δx, Δy, Δθ) in this sub-step, `b` that in the sub-step before.
  Vec3<T> motion_force(int body, const Vec3<T>& a, const Vec3<T>& b) const {
    const Damping<T>& d = damping_[body];
    Vec3<T> force(d.mass * a[0], d.mass * a[1], d.turn_slope(a[2]));
    if (!inertial()) return force;
    const Inertia<T> own = inertia(body);
    force += Vec3<T>(own.mass * (a[0] - b[0]), own.mass * (a[1] - b[1]),
                     own.turn_slope(a[2], b[2]).value);
    return force;
  }
  const Vec3<T>& control_bound() const { return control_bound_; }
  const T& friction(int pair) const { return friction_[pair]; }

  /// Returns the lanes in which a contact of the pair, or of the reversed pair, may act. It
  /// compares the distance of the parts' centres with the sum of two bounding radii: that of one
  /// part, and that of the other's offset_polygon(), which contains every vertex within the
  /// barrier's range.
  Mask<T> near(int pair, const Placement<T>& at) const {
    const PartShape &a = first(pair), &b = second(pair);
    const int i = pairs_[pair].body, j = pairs_[pair].other;
    T x = at.body(i)[0] - at.body(j)[0], y = at.body(i)[1] - at.body(j)[1];
    if (parts_[i] + parts_[j] > 2) {
      const Vec2<T> apart = turned_by(at.turns[i], a.centre) - turned_by(at.turns[j], b.centre);
      x = x + apart.x();
      y = y + apart.y();
    }
    const T reach = greater(a.radius + b.offset_radius, b.radius + a.offset_radius);
    const Mask<T> real = a.corner_count > T(0.0);
    return barrier_.plain ? real : real && x * x + y * y < reach * reach;
  }
  PairFrame<T> frame(int pair, const Placement<T>& at) const {
    const int i = pairs_[pair].body, j = pairs_[pair].other;
    return {at.body(i), at.turns[i], at.body(j), at.turns[j]};
  }
  /// Returns the largest number of vertices that the pair's first part has in any lane. Its tips
  /// come first.
  int corners(int pair) const { return first(pair).corners; }
  /// Returns the lanes in which the pair's first part has this vertex.
  Mask<T> real(int pair, int vertex) const { return first(pair).corner_count > T(vertex); }
  /// Returns the lanes in which this vertex is a tip (Shape::tips()), which can touch.
  Mask<T> is_tip(int pair, int vertex) const { return first(pair).tip_count > T(vertex); }
  ContactPoint<T> point(int pair, int vertex, const PairFrame<T>& frame) const {
    return {first(pair).vertices[vertex], frame, first(pair).rounding};
  }
  const Planes<T>& planes(int pair) const { return second(pair).planes; }
  /// Returns the sum of the radii of round corners of both parts [m].
  T rounding(int pair) const { return first(pair).rounding + second(pair).rounding; }
  /// Returns whether any body in any lane has round corners.
  bool is_rounded() const { return is_rounded_; }
  SeparatingEdges<T> edges(int pair) const { return {planes(pair), second(pair).edge_count}; }

  /// Makes `at` consistent after a change of its poses: updates the cached turns and closes all
  /// joints.
  void place(Placement<T>& at) const {
    at.update();
    articulation_.close(at);
  }
  /// Sets the movable bodies in `to` to `from` moved by `length` times `step` [3·movable], in the
  /// coordinates of the articulation.
  void advance(const Placement<T>& from, const T* step, const T& length, Placement<T>& to) const {
    for (int m = 0; m < 3 * movable_; ++m) to.p[m] = from.p[m] + length * step[m];
    to.update();
    articulation_.follow(from, step, length, to);
  }

  /// Writes the normal force λ(g(p)) of every contact to `lambda` [contacts]. For the start of a
  /// push, `spare` is Barrier::start_spare().
  void forces(const Placement<T>& at, T* lambda, double spare = 0.0) const;
  /// Returns the least gap of all contacts, but at most ĝ [m].
  T least_gap(const Placement<T>& at) const;
  /// Returns the lanes in which all pairs pass the separating-axis test (SeparatingEdges).
  Mask<T> separated(const Placement<T>& at) const;

 private:
  template <class U>
  friend class SceneModel;
  struct Room {};
  SceneModel(const SceneModel<double>& like, Room);

  /// The geometry of a part.
  struct PartShape {
    std::array<Vec2<T>, kMaxVertices> vertices;
    Planes<T> planes;
    int corners = 0;                              // the largest number in any lane
    T corner_count{}, tip_count{}, edge_count{};  // 0 in an empty lane
    T rounding{};                                 // [m]
    Vec2<T> centre;                               // in the body frame; the origin of a single part
    T radius{}, offset_radius{};  // of part and offset polygon around the centre [m]
  };
  static PartShape part_shape(const Shape& shape, std::size_t part, double range);
  const PartShape& first(int pair) const { return shapes_[pairs_[pair].part]; }
  const PartShape& second(int pair) const { return shapes_[pairs_[pair].other_part]; }

  int movable_, bodies_;
  Articulation<T> articulation_;
  std::vector<PartPair> pairs_;
  std::vector<T> friction_;  // per pair
  std::vector<int> parts_;   // per body
  std::vector<PartShape> shapes_;
  bool is_rounded_ = false;
  std::vector<Damping<T>> damping_;
  Vec3<T> control_bound_;
  Barrier barrier_;
  double sharpness_, skin_, slip_, stride_, inertia_weight_;
};

}  // namespace rtg::energy
