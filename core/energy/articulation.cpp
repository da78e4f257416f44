#include "core/energy/articulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/energy/joint_step.hpp"

namespace rtg::energy {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

template <class T>
Vec2<T> in_all_lanes(const Vector2d& v) {
  return {T(v.x()), T(v.y())};
}

/// Gives the child of a joint that holds its angle the angle of the parent, turned by α.
template <class T>
void align(const JointModel<T>& joint, Placement<T>& at) {
  if (joint.is_revolute()) return;
  T& angle = at.body(joint.child)[2];
  angle = at.body(joint.parent)[2] + joint.angle;
  at.turns[static_cast<std::size_t>(joint.child)] = turn_of(angle);
}

double reach_of(const Scene& scene, const Joint& joint) {
  if (joint.type != JointType::kRevolute) return 1.0;
  double reach = 0.0;
  for (const Part& part : scene.bodies[static_cast<std::size_t>(joint.child)].shape.parts())
    reach = std::max(reach, reach_from(joint.on_child, part));
  return reach;
}

}  // namespace

template <class T>
Articulation<T>::Articulation(const Scene& scene)
    : movable_(static_cast<int>(std::ranges::count(scene.bodies, false, &Body::fixed))) {
  for (const std::size_t k : root_first(scene)) {
    const Joint& joint = scene.joints[k];
    joints_.push_back({joint.parent, joint.child, joint.type, in_all_lanes<T>(joint.on_parent),
                       in_all_lanes<T>(joint.on_child), in_all_lanes<T>(joint.axis), T(joint.angle),
                       T(joint.lower), T(joint.upper), T(reach_of(scene, joint))});
  }
}

template <class T>
template <class U>
Articulation<T> Articulation<T>::room_for(const Articulation<U>& like) {
  Articulation out;
  out.movable_ = like.movable_;
  const Vec2<T> none(T(0.0), T(0.0));
  for (const JointModel<U>& joint : like.joints_)
    out.joints_.push_back({joint.parent, joint.child, joint.type, none, none, none, T(0.0),
                           T(-kNoLimit), T(kNoLimit), T(1.0)});
  return out;
}

template <class T>
void Articulation<T>::load(int lane, const Articulation<double>& one) {
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    JointModel<T>& to = joints_[k];
    const JointModel<double>& from = one.joints_[k];
    for (int m = 0; m < 2; ++m) {
      set_lane(to.a[m], lane, from.a[m]);
      set_lane(to.b[m], lane, from.b[m]);
      set_lane(to.axis[m], lane, from.axis[m]);
    }
    set_lane(to.angle, lane, from.angle);
    set_lane(to.lower, lane, from.lower);
    set_lane(to.upper, lane, from.upper);
    set_lane(to.reach, lane, from.reach);
  }
}

template <class T>
void Articulation<T>::unload(int lane) {
  for (JointModel<T>& joint : joints_) {
    set_lane(joint.lower, lane, -kNoLimit);
    set_lane(joint.upper, lane, kNoLimit);
  }
}

/// Sets the position of the child, whose angle is right already, from the pose of the parent and
/// from the `value` of a prismatic joint.
template <class T>
void Articulation<T>::set_child(const JointModel<T>& joint, const T& value,
                                Placement<T>& at) const {
  const auto i = static_cast<std::size_t>(joint.parent), j = static_cast<std::size_t>(joint.child);
  const T* parent = at.body(joint.parent);
  T* child = at.body(joint.child);
  const Vec2<T> a = turned_by(at.turns[i], joint.a), b = turned_by(at.turns[j], joint.b);
  for (int m = 0; m < 2; ++m) child[m] = parent[m] + a[m] - b[m];
  if (joint.type != JointType::kPrismatic) return;
  const Vec2<T> axis = turned_by(at.turns[i], joint.axis);
  for (int m = 0; m < 2; ++m) child[m] = child[m] + value * axis[m];
}

template <class T>
void Articulation<T>::close(Placement<T>& at) const {
  for (const JointModel<T>& joint : joints_) {
    align(joint, at);
    set_child(joint, value_of(joint, at), at);
  }
}

template <class T>
void Articulation<T>::follow(const Placement<T>& from, const T* step, const T& length,
                             Placement<T>& to) const {
  for (const JointModel<T>& joint : joints_) {
    T value(0.0);
    if (joint.type == JointType::kPrismatic)
      value = value_of(joint, from) + length * step[3 * joint.child];
    align(joint, to);
    set_child(joint, value, to);
  }
}

template <class T>
void Articulation<T>::apply_jacobian(const Placement<T>& at, T* y) const {
  for (const JointModel<T>& joint : joints_) JointStep<T>(*this, joint, at).spread(y);
}

template <class T>
void Articulation<T>::to_coordinates(const Placement<T>& at, T* w) const {
  for (auto joint = joints_.rbegin(); joint != joints_.rend(); ++joint)
    JointStep<T>(*this, *joint, at).undo_spread(w);
}

template <class T>
void Articulation<T>::apply_jacobian_transposed(const Placement<T>& at, T* g,
                                                const T* at_joints) const {
  for (std::size_t k = joints_.size(); k-- > 0;) {
    const JointStep<T> step(*this, joints_[k], at);
    step.gather(g);
    if (at_joints) step.add_force(at_joints[k], g);
  }
}

template class Articulation<double>;
template class Articulation<Lanes>;
template Articulation<double> Articulation<double>::room_for(const Articulation<double>&);
template Articulation<Lanes> Articulation<Lanes>::room_for(const Articulation<double>&);

}  // namespace rtg::energy
