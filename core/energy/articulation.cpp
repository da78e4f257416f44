#include "core/energy/articulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/energy/hinge_step.hpp"

namespace rtg::energy {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

}  // namespace

template <class T>
Articulation<T>::Articulation(const Scene& scene)
    : movable_(static_cast<int>(std::ranges::count(scene.bodies, false, &Body::fixed))) {
  for (const std::size_t k : root_first(scene)) {
    const Joint& joint = scene.joints[k];
    double reach = 0.0;
    for (const Part& part : scene.bodies[static_cast<std::size_t>(joint.child)].shape.parts())
      reach = std::max(reach, reach_from(joint.on_child, part));
    hinges_.push_back({joint.parent,
                       joint.child,
                       {T(joint.on_parent.x()), T(joint.on_parent.y())},
                       {T(joint.on_child.x()), T(joint.on_child.y())},
                       T(joint.lower),
                       T(joint.upper),
                       T(reach)});
  }
}

template <class T>
template <class U>
Articulation<T> Articulation<T>::room_for(const Articulation<U>& like) {
  Articulation out;
  out.movable_ = like.movable_;
  const Vec2<T> none(T(0.0), T(0.0));
  for (const Hinge<U>& hinge : like.hinges_)
    out.hinges_.push_back(
        {hinge.parent, hinge.child, none, none, T(-kNoLimit), T(kNoLimit), T(1.0)});
  return out;
}

template <class T>
void Articulation<T>::load(int lane, const Articulation<double>& one) {
  for (std::size_t k = 0; k < hinges_.size(); ++k) {
    Hinge<T>& to = hinges_[k];
    const Hinge<double>& from = one.hinges_[k];
    for (int m = 0; m < 2; ++m) {
      set_lane(to.a[m], lane, from.a[m]);
      set_lane(to.b[m], lane, from.b[m]);
    }
    set_lane(to.lower, lane, from.lower);
    set_lane(to.upper, lane, from.upper);
    set_lane(to.reach, lane, from.reach);
  }
}

template <class T>
void Articulation<T>::unload(int lane) {
  for (Hinge<T>& hinge : hinges_) {
    set_lane(hinge.lower, lane, -kNoLimit);
    set_lane(hinge.upper, lane, kNoLimit);
  }
}

template <class T>
void Articulation<T>::close(Placement<T>& at) const {
  for (const Hinge<T>& hinge : hinges_) {
    const Arms<T> arms(hinge, at);
    for (int m = 0; m < 2; ++m)
      at.body(hinge.child)[m] = at.body(hinge.parent)[m] + arms.a[m] - arms.b[m];
  }
}

template <class T>
void Articulation<T>::apply_jacobian(const Placement<T>& at, T* y) const {
  for (const Hinge<T>& hinge : hinges_) {
    const Arms<T> arms(hinge, at);
    T* child = y + 3 * hinge.child;
    child[0] = arms.b.y() * child[2];
    child[1] = -arms.b.x() * child[2];
    if (!movable(hinge.parent)) continue;
    const T* parent = y + 3 * hinge.parent;
    child[0] = child[0] + parent[0] - arms.a.y() * parent[2];
    child[1] = child[1] + parent[1] + arms.a.x() * parent[2];
  }
}

template <class T>
void Articulation<T>::apply_jacobian_transposed(const Placement<T>& at, T* g) const {
  for (auto hinge = hinges_.rbegin(); hinge != hinges_.rend(); ++hinge)
    HingeStep<T>(*this, *hinge, at).gather(g);
}

template class Articulation<double>;
template class Articulation<Lanes>;
template Articulation<double> Articulation<double>::room_for(const Articulation<double>&);
template Articulation<Lanes> Articulation<Lanes>::room_for(const Articulation<double>&);

}  // namespace rtg::energy
