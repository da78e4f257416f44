#include "core/reverse/problem/newton_system.hpp"

#include "core/energy/joint_limit.hpp"
#include "core/energy/joint_step.hpp"
#include "core/reverse/problem/joint_reduction.hpp"

namespace rtg::reverse {
namespace {

/// linearise() adds the contacts of level k this many levels after the other terms of level k. By
/// then stages k and k + 1 hold all their other terms and are still in the cache.
constexpr int kContactDelay = 3;

/// Returns the step of the joint that a limit belongs to.
template <class T>
energy::JointStep<T> step_of(const energy::SceneModel<T>& scene, const energy::Placement<T>& at,
                             int limit) {
  const energy::Articulation<T>& articulation = scene.articulation();
  return {articulation, articulation.joints()[limit / 2], at};
}

}  // namespace

template <class T>
NewtonSystem<T>::NewtonSystem(const ProblemLanes<T>& problem)
    : fixed_end_(problem.fixed_end()),
      system_(problem.energy.movable(), problem.sub_steps),
      gradient_(system_.stages.size(), system_.stages[0].q),
      residual_(gradient_),
      control_gradient_(gradient_.size()),
      eliminated_(gradient_.size(),
                  std::vector<Eliminated<T>>(static_cast<std::size_t>(problem.energy.contacts()))),
      limits_(gradient_.size(),
              std::vector<LimitTerms<T>>(problem.energy.articulation().joints().size())),
      active_(gradient_.size(), std::vector<char>(problem.energy.pairs().size())),
      moved_(gradient_[0]) {}

template <class T>
void NewtonSystem<T>::linearise(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                                const Curvature<T>& curvature) {
  curvature_ = curvature;
  const int h = problem.sub_steps;
  for (int k = 0; k <= h + kContactDelay; ++k) {
    if (k <= h) set_objective(problem, x, k);
    if (k > 0 && k <= h) {
      add_motion(problem, x, k);
      if (problem.energy.inertial()) add_inertia(problem, x, k);
      add_control(problem, x, k);
    }
    const int behind = k - kContactDelay;
    for (int n = 0; n < problem.energy.pair_count() && behind >= 0; ++n)
      add_pair(problem, x, behind, n);
  }
  if (!problem.energy.articulation().empty()) {
    for (int k = 0; k <= h; ++k) set_limits(problem, x, k);
    reduce_joints(problem, x, {system_, gradient_, residual_, limits_, curvature_.lagrangian});
  }
  for (int k = 0; k <= h; ++k)
    for (int i = 0; i < system_.M; ++i) {
      system_.stages[k].q[i] += gradient_[k][i];
      system_.stages[k].e[i] += residual_[k][i];
    }
}

template <class T>
void NewtonSystem<T>::add_pair(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k,
                               int n) {
  const energy::SceneModel<T>& scene = problem.energy;
  ContactLinearisation<T> contacts(problem, x, curvature_, k, n);
  active_[k][n] = 0;
  if (!contacts.relevant()) return;
  for (int v = 0; v < scene.corners(n); ++v)
    if (contacts.add(v, eliminated_[k][energy::contact_of(n, v)])) active_[k][n] = 1;
  if (!active_[k][n]) return;
  add_own(scene, n, contacts.frame(), contacts.own, k);
  if (k == problem.sub_steps) return;
  add_own(scene, n, contacts.frame_ahead(), contacts.next, k + 1);
  Stage& next = system_.stages[k + 1];
  const energy::PairFrame<T>&ahead = contacts.frame_ahead(), &here = contacts.frame();
  scatter(scene, n, energy::PulledBlocks<T>(ahead, contacts.F, here), next.F);
  scatter(scene, n, energy::PulledBlocks<T>(ahead, contacts.N, here), next.N);
}

/// Adds `terms` of a pair of bodies to stage k.
template <class T>
void NewtonSystem<T>::add_own(const energy::SceneModel<T>& scene, int pair,
                              const energy::PairFrame<T>& frame, const PairTerms<T>& terms, int k) {
  Stage& stage = system_.stages[k];
  pull(scene, pair, frame, terms.gradient, gradient_[k][0].data());
  pull(scene, pair, frame, terms.q, stage.q[0].data());
  scatter_lower(scene, pair, frame, terms.Q, stage.Q);
  if (k == 0) return;
  pull(scene, pair, frame, terms.e, stage.e[0].data());
  pull(scene, pair, frame, terms.residual, residual_[k][0].data());
  scatter_lower(scene, pair, frame, terms.E, stage.E);
}

/// Sets the terms of the joint limits at level k.
template <class T>
void NewtonSystem<T>::set_limits(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k) {
  using Terms = LimitLinearisation<T>;
  const energy::SceneModel<T>& scene = problem.energy;
  const typename Terms::Level level = k == 0 ? Terms::Level::kStart
                                      : k == problem.sub_steps && fixed_end_
                                          ? Terms::Level::kFixed
                                          : Terms::Level::kWithin;
  limits_[k].assign(limits_[k].size(), {});
  for_each_limit(scene.articulation(), x.p[k], [&](int l, const energy::JointLimit<T>& limit) {
    const T rate = step_of(scene, x.p[k], l).value_rate(x.multipliers[k].data());
    const Terms of({limit.gap, x.forces[k][scene.limit_contact(l)], limit.slope * rate},
                   scene.barrier(), curvature_, level);
    eliminated_[k][scene.limit_contact(l)].a = of.a;
    eliminated_[k][scene.limit_contact(l)].b[0] = of.b;
    limits_[k][l / 2].add(of.terms, limit.slope);
  });
}

template <class T>
T NewtonSystem<T>::stationarity() const {
  T top(0.0), sum(0.0);
  for (int k = 0; k <= system_.h; ++k) {
    for (const Vec3<T>& g : gradient_[k])
      for (int m = 0; m < 3 && !(k == system_.h && fixed_end_); ++m) {
        top = greater(top, magnitude(g[m]));
        sum = sum + g[m];
      }
    if (k == 0) continue;
    for (int m = 0; m < 3; ++m) {
      top = greater(top, magnitude(control_gradient_[k][m]));
      sum = sum + control_gradient_[k][m];
    }
  }
  return top + (sum - sum);
}

template <class T>
void NewtonSystem<T>::force_steps(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                                  const StageStep<T>& step, PerContact<T>& out) const {
  for (int k = 0; k <= problem.sub_steps; ++k) {
    const T* moved = step.poses[k][0].data();
    if (!problem.energy.articulation().empty()) {
      moved_ = step.poses[k];
      problem.energy.articulation().apply_jacobian(x.p[k], moved_[0].data());
      moved = moved_[0].data();
    }
    find_force_steps(problem.energy, x.p[k], k, moved, out[k].data());
  }
}

/// Writes the steps Δλ of the forces at level k to `out`. `moved` is the step of the poses of all
/// bodies [3·movable].
template <class T>
void NewtonSystem<T>::find_force_steps(const energy::SceneModel<T>& scene,
                                       const energy::Placement<T>& at, int k, const T* moved,
                                       T* out) const {
  for (int n = 0; n < scene.pair_count(); ++n) {
    T* forces = out + energy::contact_of(n, 0);
    if (!active_[k][n]) {
      for (int v = 0; v < scene.corners(n); ++v) forces[v] = T(0.0);
      continue;
    }
    const Vec4<T> along = pushed(scene, n, scene.frame(n, at), moved);
    for (int v = 0; v < scene.corners(n); ++v) {
      const Eliminated<T>& e = eliminated_[k][energy::contact_of(n, v)];
      forces[v] = e.a + e.b.dot(along);
    }
  }
  for_each_limit(scene.articulation(), at, [&](int l, const energy::JointLimit<T>& limit) {
    const Eliminated<T>& e = eliminated_[k][scene.limit_contact(l)];
    out[scene.limit_contact(l)] =
        e.a + e.b[0] * limit.slope * step_of(scene, at, l).value_rate(moved);
  });
}

/// Uses sᵀ H s = -g·s - y·A s and A s = -e. g is the linear term of the model, A the Jacobian of
/// the constraints, y the step of the multipliers.
template <class T>
T NewtonSystem<T>::model_curvature(const StageStep<T>& step) const {
  T sum(0.0);
  for (int k = 0; k <= system_.h; ++k) {
    const auto& stage = system_.stages[k];
    for (int i = 0; i < system_.M; ++i) sum = sum - stage.q[i].dot(step.poses[k][i]);
    if (k == 0) continue;
    for (int i = 0; i < system_.M; ++i) sum = sum + stage.e[i].dot(step.multipliers[k][i]);
    sum = sum - stage.r.dot(step.controls[k]);
  }
  return sum;
}

/// Uses ∇J·s = ∇L·s - y·A s and A s = -e. A is the Jacobian of the constraints, y the multipliers
/// at `x`.
template <class T>
T NewtonSystem<T>::objective_slope(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                                   const StageStep<T>& step) const {
  const energy::Articulation<T>& articulation = problem.energy.articulation();
  T sum(0.0);
  for (int k = 0; k <= system_.h; ++k) {
    for (int i = 0; i < system_.M; ++i) sum = sum + gradient_[k][i].dot(step.poses[k][i]);
    if (k == 0) continue;
    sum = sum + control_gradient_[k].dot(step.controls[k]);
    for (int i = 0; i < system_.M; ++i)
      for (int m = 0; m < 3; ++m) moved_[i][m] = x.multipliers[k][3 * i + m];
    articulation.to_coordinates(x.p[k], moved_[0].data());
    for (int i = 0; i < system_.M; ++i) sum = sum + moved_[i].dot(system_.stages[k].e[i]);
  }
  return sum;
}

template class NewtonSystem<double>;
template class NewtonSystem<Lanes>;

}  // namespace rtg::reverse
