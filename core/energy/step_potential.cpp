#include "core/energy/step_potential.hpp"

#include "core/energy/gap_terms.hpp"
#include "core/energy/joint_limit.hpp"
#include "core/energy/joint_step.hpp"

namespace rtg::energy {

template <class T>
void StepPotential<T>::begin(const Placement<T>& now, const T* previous_forces,
                             const Placement<T>* before) {
  now_ = &now;
  before_ = before;
  for (int n = 0; n < scene_.pair_count(); ++n) {
    drags_[n] = 0;
    const PairFrame<T> frame = scene_.frame(n, now);
    for (int v = 0; v < scene_.corners(n); ++v) {
      Lagged& lagged = lagged_[contact_of(n, v)];
      const T& force = previous_forces[contact_of(n, v)];
      lagged.drags = any(force != T(0.0));
      if (!lagged.drags) continue;
      drags_[n] = 1;
      const VertexContact<T> contact(scene_, n, v, frame, Mask<T>(true));
      lagged.x = contact.point.x;
      lagged.roll = contact.point.roll;
      lagged.normal = contact.distance().gradient;
      lagged.load = scene_.friction(n) * force;
    }
  }
}

/// Returns the displacement of a body in the sub-step before this one; 0 if the body was at rest.
template <class T>
Vec3<T> StepPotential<T>::previous_displacement(int body) const {
  return before_ ? displacement(*before_, *now_, body) : Vec3<T>(T(0.0), T(0.0), T(0.0));
}

/// Returns the potential of damping and inertia.
template <class T>
T StepPotential<T>::motion(const Placement<T>& next) const {
  T sum(0.0);
  for (int i = 0; i < scene_.movable(); ++i) {
    const Vec3<T> a = displacement(*now_, next, i);
    const Damping<T>& body = scene_.damping(i);
    sum = sum + T(0.5) * body.mass * (a[0] * a[0] + a[1] * a[1]) + body.turn_value(a[2]);
    if (!scene_.inertial()) continue;
    const Vec3<T> b = previous_displacement(i), gain = a - b;
    const Inertia<T> inertia = scene_.inertia(i);
    sum = sum + T(0.5) * inertia.mass * (gain[0] * gain[0] + gain[1] * gain[1]) +
          inertia.turn_value(a[2], b[2]);
  }
  return sum;
}

template <class T>
T StepPotential<T>::value(const Placement<T>& next, const T* previous_gaps, T* gaps,
                          Mask<T>& legal) const {
  T sum = motion(next);
  legal = Mask<T>(true);
  Mask<T> apart(true);
  for (int n = 0; n < scene_.pair_count(); ++n) {
    const Mask<T> close = scene_.near(n, next);
    if (n % 2 == 0) apart = !close;
    if (!any(close) && !drags_[n]) {
      for (int v = 0; v < scene_.corners(n); ++v)
        gaps[contact_of(n, v)] = VertexContact<T>::far(scene_);
      continue;
    }
    const PairFrame<T> frame = scene_.frame(n, next);
    SeparatingEdges<T> edges = scene_.edges(n);
    for (int v = 0; v < scene_.corners(n); ++v) {
      const int c = contact_of(n, v);
      const VertexContact<T> contact(scene_, n, v, frame, close);
      edges.note(contact.distances, scene_.real(n, v));
      gaps[c] = contact.gap();
      if (any(contact.within)) {
        legal = legal && is_gap_acceptable(gaps[c], previous_gaps[c], scene_.barrier());
        sum = sum + select(contact.within, scene_.barrier().value(gaps[c]), T(0.0));
      }
      if (!lagged_[c].drags) continue;
      const SlipTerms<T> s(lagged_[c].normal, contact.point, lagged_[c].x, lagged_[c].roll,
                           scene_.slip());
      sum = sum + lagged_[c].load * s.value(scene_.slip());
    }
    apart = apart || edges.separate(scene_.sharpness());  // an edge of either body suffices
    if (n % 2 == 1) legal = legal && apart;
  }
  for_each_limit(scene_.articulation(), next, [&](int l, const JointLimit<T>& limit) {
    const int c = scene_.limit_contact(l);
    gaps[c] = limit.gap;
    legal = legal && is_gap_acceptable(limit.gap, previous_gaps[c], scene_.barrier());
    sum = sum + scene_.barrier().value(limit.gap);
  });
  return sum;
}

template <class T>
void StepPotential<T>::add_motion(const Placement<T>& next, T* gradient,
                                  BlockMatrix<T>& hessian) const {
  for (int i = 0; i < scene_.movable(); ++i) {
    const Vec3<T> a = displacement(*now_, next, i), b = previous_displacement(i);
    const Vec3<T> slope = scene_.motion_force(i, a, b);
    const Damping<T>& body = scene_.damping(i);
    Vec3<T> curvature(body.mass, body.mass, body.turn_curvature(a[2]));
    if (scene_.inertial()) {
      const Inertia<T> inertia = scene_.inertia(i);
      curvature += Vec3<T>(inertia.mass, inertia.mass, inertia.turn_slope(a[2], b[2]).a);
    }
    for (int m = 0; m < 3; ++m) gradient[3 * i + m] = gradient[3 * i + m] + slope[m];
    hessian.add(i, i, diagonal(curvature));
  }
}

template <class T>
void StepPotential<T>::add_contact(const VertexContact<T>& contact, const Lagged& lagged,
                                   Vec4<T>& slope, Mat4<T>& H) const {
  if (any(contact.within)) {
    const Barrier& barrier = scene_.barrier();
    const SignedDistance<T> d = contact.distance();
    const GapTerms<T> terms(d, d.hessian(), contact.point);
    const T g = contact.gap(d, contact.within);
    const T force = select(contact.within, barrier.force(g), T(0.0));
    const T bend = select(contact.within, barrier.force_slope(g), T(0.0));
    slope -= terms.gradient * force;
    H -= (terms.gradient * bend) * terms.gradient.transpose();
    H -= terms.hessian * force;
  }
  if (!lagged.drags) return;
  const SlipTerms<T> s(lagged.normal, contact.point, lagged.x, lagged.roll, scene_.slip());
  slope += s.gradient() * lagged.load;
  H += s.hessian(contact.point) * lagged.load;
}

template <class T>
void StepPotential<T>::model(const Placement<T>& next, T* gradient, BlockMatrix<T>& hessian) const {
  add_motion(next, gradient, hessian);
  for (int n = 0; n < scene_.pair_count(); ++n) {
    const Mask<T> close = scene_.near(n, next);
    if (!any(close) && !drags_[n]) continue;
    const PairFrame<T> frame = scene_.frame(n, next);
    Vec4<T> slope = Vec4<T>::Constant(T(0.0));
    Mat4<T> H = Mat4<T>::Constant(T(0.0));
    bool touched = false;
    for (int v = 0; v < scene_.corners(n); ++v) {
      const VertexContact<T> contact(scene_, n, v, frame, close);
      const Lagged& lagged = lagged_[contact_of(n, v)];
      if (!any(contact.within) && !lagged.drags) continue;
      touched = true;
      add_contact(contact, lagged, slope, H);
    }
    if (!touched) continue;
    pull(scene_, n, frame, slope, gradient);
    scatter_lower(scene_, n, frame, H, hessian);
  }
}

template <class T>
void StepPotential<T>::reduce(const Placement<T>& next, T* gradient,
                              BlockMatrix<T>& hessian) const {
  const Articulation<T>& articulation = scene_.articulation();
  if (articulation.empty()) return;
  mirror_lower(hessian);
  for (std::size_t n = articulation.joints().size(); n-- > 0;) {
    const JointModel<T>& joint = articulation.joints()[n];
    const JointStep<T> step(articulation, joint, next);
    step.gather_both(hessian);
    step.add_curvature(gradient, T(1.0), hessian);
    step.gather(gradient);
    for (const bool upper : {false, true}) {
      const JointLimit<T> limit(joint, upper, value_of(joint, next));
      step.add_force(-scene_.barrier().force(limit.gap) * limit.slope, gradient);
      step.add_stiffness(-scene_.barrier().force_slope(limit.gap) * limit.slope * limit.slope,
                         hessian);
    }
  }
}

template class StepPotential<double>;
template class StepPotential<Lanes>;

}  // namespace rtg::energy
