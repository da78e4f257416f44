#include "core/energy/scene_model.hpp"

#include <algorithm>
#include <cassert>

#include "core/energy/joint_limit.hpp"
#include "core/energy/vertex_contact.hpp"

namespace rtg::energy {
namespace {

constexpr double kFarAway = 1e3;  // offset of the unused planes of a polygon [m]

int movable_bodies(const Scene& scene) {
  int count = 0;
  for (const Body& body : scene.bodies) {
    assert(body.fixed || &body == &scene.bodies[static_cast<std::size_t>(count)]);
    count += body.fixed ? 0 : 1;
  }
  return count;
}

template <class T>
Planes<T> all_planes(const Polygon& core) {
  const HalfPlanes real = half_planes(core);
  Planes<T> out;
  out.count = real.count;
  const auto lanes = [](const Vector2d& v) { return Vec2<T>(T(v.x()), T(v.y())); };
  for (int k = 0; k < static_cast<int>(kMaxVertices); ++k) {
    const bool exists = k < real.count;
    out.normal[k] = lanes(exists ? real.normal[k] : Vector2d::Zero());
    out.offset[k] = T(exists ? real.offset[k] : kFarAway);
    out.corner[k] = lanes(exists ? real.corner[k] : Vector2d(kFarAway, 0.0));
    out.edge[k] = lanes(exists ? real.edge[k] : Vector2d::Zero());
    out.inverse_square[k] = T(exists ? real.inverse_square[k] : 0.0);
  }
  return out;
}

}  // namespace

/// `range` is the distance up to which the part exerts contact forces [m].
template <class T>
typename SceneModel<T>::PartShape SceneModel<T>::part_shape(const Shape& shape, std::size_t part,
                                                            double range) {
  const auto& [core, rounding] = shape.parts()[part];
  Vector2d centre = Vector2d::Zero();
  if (shape.parts().size() > 1)
    centre = core.size() == 1 ? core.vertices[0] : moments(core).centroid;
  PartShape out;
  out.planes = all_planes<T>(core);
  out.corners = static_cast<int>(core.size());
  out.corner_count = T(out.corners);
  out.edge_count = T(core.size() == 1 ? 0 : out.corners);
  out.rounding = T(rounding);
  out.centre = {T(centre.x()), T(centre.y())};
  out.radius = T(reach_from(centre, shape.parts()[part]));
  out.offset_radius = core.size() == 1
                          ? out.radius + T(range)
                          : T(reach_from(centre, {offset_polygon(core, range), rounding}));
  // Tips first. The order of vertices matters to the planes alone.
  std::vector<std::size_t> order = shape.tips(part);
  out.tip_count = T(static_cast<int>(order.size()));
  for (std::size_t v = 0; v < core.size(); ++v)
    if (std::ranges::find(shape.tips(part), v) == shape.tips(part).end()) order.push_back(v);
  out.vertices.fill({T(0.0), T(0.0)});
  for (std::size_t v = 0; v < core.size(); ++v)
    out.vertices[v] = {T(core.vertices[order[v]].x()), T(core.vertices[order[v]].y())};
  return out;
}

template <class T>
SceneModel<T>::SceneModel(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push)
    : movable_(movable_bodies(scene)),
      bodies_(static_cast<int>(scene.size())),
      articulation_(scene),
      sharpness_(physics.sharpness),
      skin_(physics.skin),
      slip_(physics.slip),
      stride_(longest_stride(push) / physics.sub_steps),
      inertia_weight_(physics.inertia_weight()) {
  const double unit = physics.damping / (physics.time_step * physics.time_step);  // k_D/Δt²
  barrier_ = {physics.barrier / unit, physics.range, physics.plain_barrier};
  std::vector<int> first_part;
  for (const Body& body : scene.bodies) {
    const Mass mass = mass_of(body);
    damping_.push_back({T(mass.mass), T(mass.moment), physics.periodic_turns});
    first_part.push_back(static_cast<int>(shapes_.size()));
    parts_.push_back(static_cast<int>(body.shape.parts().size()));
    for (std::size_t n = 0; n < body.shape.parts().size(); ++n) {
      shapes_.push_back(part_shape(body.shape, n, physics.range + physics.skin));
      is_rounded_ = is_rounded_ || body.shape.parts()[n].radius > 0.0;
    }
  }
  // The force that holds the robot at push speed, plus the force that accelerates it to push speed
  // within a sub-step.
  const T drag = damping_[0].mass * T(stride_ * (1.0 + inertia_weight_));
  control_bound_ = {T(physics.force_factor) * drag, T(physics.force_factor) * drag,
                    T(physics.torque_factor) * drag * T(scene.bodies[0].shape.radius())};
  for (int i = 0; i < bodies_; ++i)
    for (int j = i + 1; j < bodies_; ++j) {
      if ((!movable(i) && !movable(j)) || jointed(scene, i, j)) continue;
      for (int m = first_part[i]; m < first_part[i] + parts_[i]; ++m)
        for (int n = first_part[j]; n < first_part[j] + parts_[j]; ++n) {
          pairs_.push_back({i, j, m, n});
          pairs_.push_back({j, i, n, m});
        }
    }
  for (const PartPair& pair : pairs_)
    friction_.push_back(T(pair_friction(scene.bodies[pair.body], scene.bodies[pair.other])));
}

template <class T>
SceneModel<T>::SceneModel(const SceneModel<double>& like, Room)
    : movable_(like.movable_),
      bodies_(like.bodies_),
      articulation_(Articulation<T>::room_for(like.articulation_)),
      pairs_(like.pairs_),
      friction_(pairs_.size(), T(0.0)),
      parts_(like.parts_),
      shapes_(like.shapes_.size()),
      damping_(like.damping_.size(), {T(1.0), T(1.0), like.damping_[0].periodic}),
      control_bound_(Vec3<T>::Constant(T(1.0))),
      barrier_(like.barrier_),
      sharpness_(like.sharpness_),
      skin_(like.skin_),
      slip_(like.slip_),
      stride_(like.stride_),
      inertia_weight_(like.inertia_weight_) {}

template <class T>
void SceneModel<T>::unload(int lane) {
  for (PartShape& shape : shapes_)
    for (T* count : {&shape.corner_count, &shape.tip_count, &shape.edge_count})
      set_lane(*count, lane, 0.0);
  articulation_.unload(lane);
}

template <class T>
void SceneModel<T>::load(int lane, const SceneModel<double>& one) {
  assert(one.parts_ == parts_ && one.movable_ == movable_);
  articulation_.load(lane, one.articulation_);
  is_rounded_ = is_rounded_ || one.is_rounded_;
  for (std::size_t i = 0; i < damping_.size(); ++i) {
    set_lane(damping_[i].mass, lane, one.damping_[i].mass);
    set_lane(damping_[i].moment, lane, one.damping_[i].moment);
  }
  const auto set = [lane](Vec2<T>& to, const Vector2d& from) {
    for (int m = 0; m < 2; ++m) set_lane(to[m], lane, from[m]);
  };
  for (std::size_t n = 0; n < shapes_.size(); ++n) {
    PartShape& to = shapes_[n];
    const auto& from = one.shapes_[n];
    to.corners = std::max(to.corners, from.corners);
    to.planes.count = std::max(to.planes.count, from.planes.count);
    set_lane(to.corner_count, lane, from.corner_count);
    set_lane(to.tip_count, lane, from.tip_count);
    set_lane(to.edge_count, lane, from.edge_count);
    set_lane(to.rounding, lane, from.rounding);
    set_lane(to.radius, lane, from.radius);
    set_lane(to.offset_radius, lane, from.offset_radius);
    set(to.centre, from.centre);
    for (std::size_t k = 0; k < kMaxVertices; ++k) {
      set(to.vertices[k], from.vertices[k]);
      set(to.planes.normal[k], from.planes.normal[k]);
      set(to.planes.corner[k], from.planes.corner[k]);
      set(to.planes.edge[k], from.planes.edge[k]);
      set_lane(to.planes.offset[k], lane, from.planes.offset[k]);
      set_lane(to.planes.inverse_square[k], lane, from.planes.inverse_square[k]);
    }
  }
  for (std::size_t n = 0; n < pairs_.size(); ++n) set_lane(friction_[n], lane, one.friction_[n]);
  for (int m = 0; m < 3; ++m) set_lane(control_bound_[m], lane, one.control_bound_[m]);
}

template <class T>
void SceneModel<T>::forces(const Placement<T>& at, T* lambda, double spare) const {
  for (int n = 0; n < pair_count(); ++n) {
    const Mask<T> close = near(n, at);
    T* of = lambda + contact_of(n, 0);
    for (int v = 0; v < static_cast<int>(kMaxVertices); ++v) of[v] = T(0.0);
    if (!any(close)) continue;
    const PairFrame<T> pair = frame(n, at);
    for (int v = 0; v < corners(n); ++v) {
      const VertexContact<T> contact(*this, n, v, pair, close);
      if (any(contact.within))
        of[v] = select(contact.within, barrier_.force(contact.gap(), spare), T(0.0));
    }
  }
  for_each_limit(articulation_, at, [&](int l, const JointLimit<T>& limit) {
    lambda[limit_contact(l)] = barrier_.force(limit.gap);
  });
}

template <class T>
T SceneModel<T>::least_gap(const Placement<T>& at) const {
  T least(barrier_.range);
  for (int n = 0; n < pair_count(); ++n) {
    const Mask<T> close = near(n, at);
    if (!any(close)) continue;
    const PairFrame<T> pair = frame(n, at);
    for (int v = 0; v < corners(n); ++v)
      least = lesser(least, VertexContact<T>(*this, n, v, pair, close).gap());
  }
  for_each_limit(articulation_, at,
                 [&](int, const JointLimit<T>& limit) { least = lesser(least, limit.gap); });
  return least;
}

template <class T>
Mask<T> SceneModel<T>::separated(const Placement<T>& at) const {
  Mask<T> all(true), apart(true);
  for (int n = 0; n < pair_count(); ++n) {
    const Mask<T> close = near(n, at);
    if (n % 2 == 0) apart = !close;
    if (any(close)) {
      SeparatingEdges<T> sides = edges(n);
      const PairFrame<T> pair = frame(n, at);
      for (int v = 0; v < corners(n); ++v)
        sides.note(VertexContact<T>(*this, n, v, pair, close).distances, real(n, v));
      apart = apart || sides.separate(sharpness_);
    }
    if (n % 2 == 1) all = all && apart;
  }
  return all;
}

template class SceneModel<double>;
template class SceneModel<Lanes>;

}  // namespace rtg::energy
