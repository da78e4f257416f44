#include "core/reverse/newton_system.hpp"

namespace rtg {

template <class T>
NewtonSystem<T>::NewtonSystem(const ProblemLanes<T>& problem)
    : fixed_end_(problem.fixed_end()),
      system_(problem.energy.movable(), problem.sub_steps),
      gradient_(system_.stages.size(), system_.stages[0].q),
      control_gradient_(gradient_.size()),
      eliminated_(gradient_.size(),
                  std::vector<Eliminated<T>>(static_cast<std::size_t>(problem.energy.contacts()))),
      active_(gradient_.size(), std::vector<char>(problem.energy.pairs().size())) {}

template <class T>
void NewtonSystem<T>::linearise(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                                const Curvature<T>& curvature) {
  curvature_ = curvature;
  const int h = problem.sub_steps;
  for (int k = 0; k <= h; ++k) set_objective(problem, x, k);
  for (int k = 1; k <= h; ++k) {
    add_motion(problem, x, k);
    add_control(problem, x, k);
  }
  for (int k = 0; k <= h; ++k)
    for (int n = 0; n < problem.energy.pair_count(); ++n) add_pair(problem, x, k, n);
  for (int k = 0; k <= h; ++k)
    for (int i = 0; i < system_.M; ++i) system_.stages[k].q[i] += gradient_[k][i];
}

/// Begins stage k with the terms of one level in the objective, barrier aside, and the proximal
/// one.
template <class T>
void NewtonSystem<T>::set_objective(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k) {
  const ReverseConfig& config = problem.config;
  Stage& stage = system_.stages[k];
  for (BlockMatrix<T>* block : {&stage.Q, &stage.E, &stage.F, &stage.N}) block->clear();
  const bool end = k == problem.sub_steps;
  const T spring(end ? config.terminal_weight : 0.0);
  for (int i = 0; i < system_.M; ++i) {
    stage.q[i].setConstant(T(0.0));
    stage.e[i].setConstant(T(0.0));
    Vec3<T>& g = gradient_[k][i];
    Block<T> own = Block<T>::Constant(T(0.0));
    for (int m = 0; m < 3; ++m) {
      g[m] = spring * (x.p[k].body(i)[m] - problem.end[3 * i + m]);
      own(m, m) = curvature_.proximal + spring;
    }
    if (k == 0) {
      const T pull(i == 0 ? config.robot_weight : config.object_weight);
      g[0] += pull * problem.direction.x();
      g[1] += pull * problem.direction.y();
    }
    stage.Q.add(i, i, own);
  }
  const Vec3<T> path = problem.robot_path(k);
  for (int m = 0; m < 3; ++m) {
    const T weight(2.0 * (m < 2 ? config.path_weight : config.heading_weight));
    stage.Q.at(0, 0)(m, m) += weight;
    gradient_[k][0][m] += weight * (x.p[k].body(0)[m] - path[m]);
  }
}

/// Damping and the price of speed of sub-step k.
template <class T>
void NewtonSystem<T>::add_motion(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k) {
  Stage &stage = system_.stages[k], &before = system_.stages[k - 1];
  for (int i = 0; i < system_.M; ++i) {
    const T *to = x.p[k].body(i), *from = x.p[k - 1].body(i);
    const T* y = x.multipliers[k].data() + 3 * i;
    const Damping<T>& body = problem.energy.damping(i);
    const T turn = to[2] - from[2];
    const Vec3<T> slope(body.mass, body.mass, body.turn_curvature(turn));
    stage.e[i] += Vec3<T>(body.mass * (to[0] - from[0]), body.mass * (to[1] - from[1]),
                          body.turn_slope(turn));
    Block<T> E = Block<T>::Constant(T(0.0)), H = E;
    for (int m = 0; m < 3; ++m) {
      E(m, m) = slope[m];
      gradient_[k][i][m] += slope[m] * y[m];
      gradient_[k - 1][i][m] -= slope[m] * y[m];
    }
    H(2, 2) = curvature_.exact * body.turn_third(turn) * y[2];
    if (i > 0) {
      const SpeedPenalty<T> speed = problem.speed(x, k, i);
      H += speed.hessian;
      gradient_[k][i] += speed.gradient;
      gradient_[k - 1][i] -= speed.gradient;
    }
    stage.E.add(i, i, E);
    stage.F.add(i, i, -E);
    stage.Q.add(i, i, H);
    before.Q.add(i, i, H);
    stage.N.add(i, i, -H);
  }
}

template <class T>
void NewtonSystem<T>::add_control(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k) {
  Stage& stage = system_.stages[k];
  const T price(2.0 * problem.config.control_weight);
  for (int m = 0; m < 3; ++m) {
    const T push = hyperbolic_tangent(x.controls[k][m]);
    const T bound = problem.energy.control_bound()[m], y = x.multipliers[k][m];
    const T slope = -bound * (T(1.0) - push * push);
    stage.e[0][m] -= bound * push;
    stage.B[m] = slope;
    stage.R[m] = price + curvature_.proximal - curvature_.exact * T(2.0) * push * slope * y;
    stage.r[m] = control_gradient_[k][m] = price * x.controls[k][m] + slope * y;
  }
}

template <class T>
void NewtonSystem<T>::add_pair(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k,
                               int n) {
  const SceneModel<T>& scene = problem.energy;
  ContactLinearisation<T> contacts(problem, x, curvature_, k, n);
  active_[k][n] = 0;
  if (!contacts.relevant()) return;
  for (int v = 0; v < scene.corners(n); ++v)
    if (contacts.add(v, eliminated_[k][contact_of(n, v)])) active_[k][n] = 1;
  if (!active_[k][n]) return;
  add_own(scene, n, contacts.frame(), contacts.own, k);
  if (k == problem.sub_steps) return;
  add_own(scene, n, contacts.frame_ahead(), contacts.next, k + 1);
  Stage& next = system_.stages[k + 1];
  const PairFrame<T>&ahead = contacts.frame_ahead(), &here = contacts.frame();
  scatter(scene, n, PulledBlocks<T>(ahead, contacts.F, here), next.F);
  scatter(scene, n, PulledBlocks<T>(ahead, contacts.N, here), next.N);
}

/// What a pair adds to one stage.
template <class T>
void NewtonSystem<T>::add_own(const SceneModel<T>& scene, int pair, const PairFrame<T>& frame,
                              const PairTerms<T>& terms, int k) {
  Stage& stage = system_.stages[k];
  pull(scene, pair, frame, terms.gradient, gradient_[k][0].data());
  pull(scene, pair, frame, terms.q, stage.q[0].data());
  scatter_lower(scene, pair, frame, terms.Q, stage.Q);
  if (k == 0) return;
  pull(scene, pair, frame, terms.e, stage.e[0].data());
  scatter_lower(scene, pair, frame, terms.E, stage.E);
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
  const SceneModel<T>& energy = problem.energy;
  for (int k = 0; k <= problem.sub_steps; ++k)
    for (int n = 0; n < energy.pair_count(); ++n) {
      T* forces = out[k].data() + contact_of(n, 0);
      if (!active_[k][n]) {
        for (int v = 0; v < energy.corners(n); ++v) forces[v] = T(0.0);
        continue;
      }
      const Vec4<T> moved = pushed(energy, n, energy.frame(n, x.p[k]), step.poses[k][0].data());
      for (int v = 0; v < energy.corners(n); ++v) {
        const Eliminated<T>& e = eliminated_[k][contact_of(n, v)];
        forces[v] = e.a + e.b.dot(moved);
      }
    }
}

/// sᵀ H s = -g·s - y·A s, and A s = -e.
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

/// ∇J·s = ∇L·s - y·A s.
template <class T>
T NewtonSystem<T>::objective_slope(const Trajectory<T>& x, const StageStep<T>& step) const {
  T sum(0.0);
  for (int k = 0; k <= system_.h; ++k) {
    for (int i = 0; i < system_.M; ++i) sum = sum + gradient_[k][i].dot(step.poses[k][i]);
    if (k == 0) continue;
    sum = sum + control_gradient_[k].dot(step.controls[k]);
    for (std::size_t m = 0; m < x.multipliers[k].size(); ++m)
      sum = sum + x.multipliers[k][m] * system_.stages[k].e[m / 3][m % 3];
  }
  return sum;
}

template class NewtonSystem<double>;
template class NewtonSystem<Lanes>;

}  // namespace rtg
