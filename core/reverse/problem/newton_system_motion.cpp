// The terms of the Newton system from the objective, motion and controls. newton_system.cpp has
// those from contacts and joints.

#include "core/reverse/problem/control_force.hpp"
#include "core/reverse/problem/newton_system.hpp"
#include "core/reverse/problem/objective_terms.hpp"

namespace rtg::reverse {
namespace {

template <class T>
Vec3<T> nothing() {
  return Vec3<T>::Constant(T(0.0));
}

template <class T>
Vec3<T> multipliers_of(const Trajectory<T>& x, int k, int body) {
  const T* y = x.multipliers[k].data() + 3 * body;
  return {y[0], y[1], y[2]};
}

/// Returns how far `body` moved in sub-step k - 1; zero if k = 1, as all bodies begin at rest.
template <class T>
Vec3<T> previous_displacement(const Trajectory<T>& x, int k, int body) {
  return k == 1 ? nothing<T>() : displacement(x.p[k - 2], x.p[k - 1], body);
}

}  // namespace

/// Initialises stage k with the proximal term and the objective of p_k: the pull on the start, the
/// spring to the final state and the path penalty.
template <class T>
void NewtonSystem<T>::set_objective(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k) {
  Stage& stage = system_.stages[k];
  for (BlockMatrix<T>* block : {&stage.Q, &stage.E, &stage.F, &stage.G, &stage.N, &stage.U})
    block->clear();
  const EndSpring<T> spring(problem, x.p[k], k);
  for (int i = 0; i < system_.M; ++i) {
    stage.q[i].setConstant(T(0.0));
    stage.e[i].setConstant(T(0.0));
    residual_[k][i].setConstant(T(0.0));
    for (int m = 0; m < 3; ++m) gradient_[k][i][m] = spring.gradient(i, m);
    if (k == 0) gradient_[k][i] += StartTerm<T>(problem, x.p[0], i).gradient;
    stage.Q.add(i, i, diagonal<T>(Vec3<T>::Constant(curvature_.proximal + spring.hessian)));
  }
  const PathPenalty<T> path(problem, x.p[k], k);
  gradient_[k][0] += path.gradient;
  stage.Q.add(0, 0, diagonal<T>(path.hessian));
}

/// Adds the damping and the speed penalty of sub-step k. Also adds the inertial force to Φ_k;
/// add_inertia() adds its derivatives.
template <class T>
void NewtonSystem<T>::add_motion(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k) {
  Stage &stage = system_.stages[k], &before = system_.stages[k - 1];
  for (int i = 0; i < system_.M; ++i) {
    const Vec3<T> moved = displacement(x.p[k - 1], x.p[k], i), y = multipliers_of(x, k, i);
    const energy::Damping<T>& body = problem.energy.damping(i);
    const Vec3<T> slope(body.mass, body.mass, body.turn_curvature(moved[2]));
    residual_[k][i] += problem.energy.motion_force(i, moved, previous_displacement(x, k, i));
    gradient_[k][i] += slope.cwiseProduct(y);
    gradient_[k - 1][i] -= slope.cwiseProduct(y);
    Block<T> H = diagonal<T>(
        Vec3<T>(T(0.0), T(0.0), curvature_.lagrangian * body.turn_third(moved[2]) * y[2]));
    if (i > 0) {
      const SpeedPenalty<T> speed = problem.speed(x, k, i);
      H += speed.hessian;
      gradient_[k][i] += speed.gradient;
      gradient_[k - 1][i] -= speed.gradient;
    }
    stage.E.add(i, i, diagonal<T>(slope));
    stage.F.add(i, i, diagonal<T>(-slope));
    stage.Q.add(i, i, H);
    before.Q.add(i, i, H);
    stage.N.add(i, i, -H);
  }
}

/// Adds the derivatives of the inertial force in Φ_k. The force depends on the motions in sub-steps
/// k - 1 and k. All bodies are at rest before the first sub-step.
template <class T>
void NewtonSystem<T>::add_inertia(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k) {
  const bool first = k == 1;
  for (int i = 0; i < system_.M; ++i) {
    const energy::Inertia<T> body = problem.energy.inertia(i);
    const Vec3<T> a = displacement(x.p[k - 1], x.p[k], i);
    const Vec3<T> b = previous_displacement(x, k, i);
    const Vec3<T> y = multipliers_of(x, k, i);
    auto turn = body.turn_slope(a[2], b[2]);
    if (first) turn.b = turn.ab = turn.bb = T(0.0);
    const Vec3<T> by_a(body.mass, body.mass, turn.a);
    const Vec3<T> by_b = first ? nothing<T>() : Vec3<T>(-body.mass, -body.mass, turn.b);
    Stage& stage = system_.stages[k];
    stage.E.add(i, i, diagonal<T>(by_a));
    stage.F.add(i, i, diagonal<T>(by_b - by_a));
    gradient_[k][i] += by_a.cwiseProduct(y);
    gradient_[k - 1][i] += (by_b - by_a).cwiseProduct(y);
    if (!first) {
      stage.G.add(i, i, diagonal<T>(-by_b));
      gradient_[k - 2][i] -= by_b.cwiseProduct(y);
    }
    if (body.periodic) add_turn_curvature(turn, curvature_.lagrangian * y[2], k, i);
  }
}

/// Adds the second derivatives of y·Φ_k with respect to the angles of body i.
template <class T>
void NewtonSystem<T>::add_turn_curvature(const typename energy::Inertia<T>::Slope& s, const T& y,
                                         int k, int i) {
  const auto entry = [](const T& x) { return diagonal<T>(Vec3<T>(T(0.0), T(0.0), x)); };
  Stage &stage = system_.stages[k], &before = system_.stages[k - 1];
  stage.Q.add(i, i, entry(y * s.aa));
  stage.N.add(i, i, entry(y * (s.ab - s.aa)));
  before.Q.add(i, i, entry(y * (s.aa - T(2.0) * s.ab + s.bb)));
  if (k == 1) return;
  stage.U.add(i, i, entry(-y * s.ab));
  before.N.add(i, i, entry(y * (s.ab - s.bb)));
  system_.stages[k - 2].Q.add(i, i, entry(y * s.bb));
}

template <class T>
void NewtonSystem<T>::add_control(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k) {
  Stage& stage = system_.stages[k];
  const ControlPenalty<T> price(problem, x.controls[k]);
  for (int m = 0; m < 3; ++m) {
    const ControlForce<T> force(problem.energy.control_bound()[m], x.controls[k][m]);
    const T y = x.multipliers[k][m];
    residual_[k][0][m] -= force.value;
    stage.B[m] = -force.slope;
    stage.R[m] = price.hessian + curvature_.proximal - curvature_.lagrangian * force.curvature * y;
    stage.r[m] = control_gradient_[k][m] = price.gradient[m] - force.slope * y;
  }
}

template void NewtonSystem<double>::set_objective(const ProblemLanes<double>&,
                                                  const Trajectory<double>&, int);
template void NewtonSystem<double>::add_motion(const ProblemLanes<double>&,
                                               const Trajectory<double>&, int);
template void NewtonSystem<double>::add_inertia(const ProblemLanes<double>&,
                                                const Trajectory<double>&, int);
template void NewtonSystem<double>::add_control(const ProblemLanes<double>&,
                                                const Trajectory<double>&, int);
template void NewtonSystem<Lanes>::set_objective(const ProblemLanes<Lanes>&,
                                                 const Trajectory<Lanes>&, int);
template void NewtonSystem<Lanes>::add_motion(const ProblemLanes<Lanes>&, const Trajectory<Lanes>&,
                                              int);
template void NewtonSystem<Lanes>::add_inertia(const ProblemLanes<Lanes>&, const Trajectory<Lanes>&,
                                               int);
template void NewtonSystem<Lanes>::add_control(const ProblemLanes<Lanes>&, const Trajectory<Lanes>&,
                                               int);

}  // namespace rtg::reverse
