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
Planes<T> all_planes(const Polygon& shape) {
  const HalfPlanes real = half_planes(shape);
  Planes<T> out;
  out.count = real.count;
  for (int k = 0; k < static_cast<int>(kMaxVertices); ++k) {
    const bool exists = k < real.count;
    out.normal[k] = {T(exists ? real.normal[k].x() : 0.0), T(exists ? real.normal[k].y() : 0.0)};
    out.offset[k] = T(exists ? real.offset[k] : kFarAway);
  }
  return out;
}

}  // namespace

template <class T>
SceneModel<T>::SceneModel(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push)
    : movable_(movable_bodies(scene)),
      bodies_(static_cast<int>(scene.size())),
      articulation_(scene),
      sharpness_(physics.sharpness),
      skin_(physics.skin),
      slip_(physics.slip),
      stride_(push.stride / physics.sub_steps),
      inertia_weight_(physics.inertia_weight()) {
  const double unit = physics.damping / (physics.time_step * physics.time_step);  // k_D/Δt²
  barrier_ = {physics.barrier / unit, physics.range, physics.plain_barrier};
  for (const Body& body : scene.bodies) {
    const Mass mass = mass_of(body);
    damping_.push_back({T(mass.mass), T(mass.moment), physics.periodic_turns});
    radius_.push_back(T(bounding_radius(body.shape)));
    offset_radius_.push_back(
        T(bounding_radius(offset_polygon(body.shape, physics.range + physics.skin))));
    corners_.push_back(static_cast<int>(body.shape.size()));
    corner_count_.push_back(T(corners_.back()));
    planes_.push_back(all_planes<T>(body.shape));
    vertices_.emplace_back();
    vertices_.back().fill({T(0.0), T(0.0)});
    for (std::size_t v = 0; v < body.shape.size(); ++v)
      vertices_.back()[v] = {T(body.shape.vertices[v].x()), T(body.shape.vertices[v].y())};
  }
  // The force that holds the robot at push speed, plus the force that accelerates it to push speed
  // within a sub-step.
  const T drag = damping_[0].mass * T(stride_ * (1.0 + inertia_weight_));
  control_bound_ = {T(physics.force_factor) * drag, T(physics.force_factor) * drag,
                    T(physics.torque_factor) * drag * radius_[0]};
  for (int i = 0; i < bodies_; ++i)
    for (int j = i + 1; j < bodies_; ++j)
      if ((movable(i) || movable(j)) && !jointed(scene, i, j)) {
        pairs_.push_back({i, j});
        pairs_.push_back({j, i});
      }
  for (const BodyPair& pair : pairs_)
    friction_.push_back(T(pair_friction(scene.bodies[pair.body], scene.bodies[pair.other])));
}

template <class T>
SceneModel<T>::SceneModel(const SceneModel<double>& like, Room)
    : movable_(like.movable_),
      bodies_(like.bodies_),
      articulation_(Articulation<T>::room_for(like.articulation_)),
      pairs_(like.pairs_),
      friction_(pairs_.size(), T(0.0)),
      vertices_(like.vertices_.size()),
      corners_(vertices_.size(), 0),
      corner_count_(vertices_.size(), T(0.0)),
      planes_(vertices_.size()),
      radius_(corner_count_),
      offset_radius_(corner_count_),
      damping_(vertices_.size(), {T(1.0), T(1.0), like.damping_[0].periodic}),
      control_bound_(Vec3<T>::Constant(T(1.0))),
      barrier_(like.barrier_),
      sharpness_(like.sharpness_),
      skin_(like.skin_),
      slip_(like.slip_),
      stride_(like.stride_),
      inertia_weight_(like.inertia_weight_) {}

template <class T>
void SceneModel<T>::unload(int lane) {
  for (T& count : corner_count_) set_lane(count, lane, 0.0);
  articulation_.unload(lane);
}

template <class T>
void SceneModel<T>::load(int lane, const SceneModel<double>& one) {
  assert(one.bodies_ == bodies_ && one.movable_ == movable_);
  articulation_.load(lane, one.articulation_);
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    set_lane(damping_[i].mass, lane, one.damping_[i].mass);
    set_lane(damping_[i].moment, lane, one.damping_[i].moment);
    set_lane(radius_[i], lane, one.radius_[i]);
    set_lane(offset_radius_[i], lane, one.offset_radius_[i]);
    set_lane(corner_count_[i], lane, one.corner_count_[i]);
    corners_[i] = std::max(corners_[i], one.corners_[i]);
    planes_[i].count = std::max(planes_[i].count, one.planes_[i].count);
    for (std::size_t k = 0; k < kMaxVertices; ++k) {
      for (int m = 0; m < 2; ++m) {
        set_lane(vertices_[i][k][m], lane, one.vertices_[i][k][m]);
        set_lane(planes_[i].normal[k][m], lane, one.planes_[i].normal[k][m]);
      }
      set_lane(planes_[i].offset[k], lane, one.planes_[i].offset[k]);
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
