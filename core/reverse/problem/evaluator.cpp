#include "core/reverse/problem/evaluator.hpp"

#include <algorithm>

#include "core/energy/joint_limit.hpp"
#include "core/energy/scatter.hpp"
#include "core/energy/slip_terms.hpp"
#include "core/energy/vertex_contact.hpp"
#include "core/reverse/problem/control_force.hpp"
#include "core/reverse/problem/objective_terms.hpp"

namespace rtg::reverse {
namespace {

/// Sets `e` to Φ_k without contacts.
template <class T>
void set_free_residual(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k, T* e) {
  const energy::SceneModel<T>& energy = problem.energy;
  for (int i = 0; i < energy.movable(); ++i) {
    const Vec3<T> force = energy.motion_force(i, displacement(x.p[k - 1], x.p[k], i),
                                              displacement(x.p[std::max(k - 2, 0)], x.p[k - 1], i));
    for (int m = 0; m < 3; ++m) e[3 * i + m] = force[m];
  }
  for (int m = 0; m < 3; ++m)
    e[m] = e[m] - ControlForce<T>(energy.control_bound()[m], x.controls[k][m]).value;
}

/// Returns J without the barrier at the start.
template <class T>
T free_objective(const ProblemLanes<T>& problem, const Trajectory<T>& x) {
  const int h = problem.sub_steps, movable = problem.energy.movable();
  T sum(0.0);
  for (int i = 0; i < movable; ++i) sum = sum + StartTerm<T>(problem, x.p[0], i).value;
  for (int k = 0; k <= h; ++k) {
    if (k > 0) sum = sum + ControlPenalty<T>(problem, x.controls[k]).value;
    const PathPenalty<T> path(problem, x.p[k], k);
    sum = sum + path.position + path.heading;
  }
  for (int k = 1; k <= h; ++k)
    for (int i = 1; i < movable; ++i) sum = sum + problem.speed(x, k, i).value;
  for (int k = h; k > 0 && problem.is_terminal(k); --k)
    sum = sum + EndSpring<T>(problem, x.p[k], k).value();
  return sum;
}

}  // namespace

/// An evaluation of a trajectory, level by level. The contacts at level k enter Φ_k by their normal
/// force and Φ_{k+1} by their friction.
template <class T>
struct Evaluator<T>::Pass {
  Evaluator& into;
  const ProblemLanes<T>& problem;
  const Trajectory<T>& x;
  const PerContact<T>& previous_gaps;
  PerContact<T>& gaps;
  Mask<T>& legal;
  Measures<T> sum = {};
  const energy::SceneModel<T>& scene = problem.energy;

  void add_level(int k) {
    Mask<T> apart(true);
    for (int n = 0; n < scene.pair_count(); ++n) {
      const Mask<T> close = scene.near(n, x.p[k]);
      if (n % 2 == 0) apart = !close;
      for (int v = 0; v < scene.corners(n); ++v) {
        gaps[k][energy::contact_of(n, v)] = energy::VertexContact<T>::far(scene);
        into.complementarity_[k][energy::contact_of(n, v)] = T(0.0);
      }
      if (any(close) || has_force(k, n)) apart = add_pair(k, n, close) || apart;
      if (n % 2 == 1) legal = legal && apart;  // an edge of either body suffices
    }
    add_limits(k);
  }

  void add_limits(int k) {
    std::ranges::fill(into.at_joints_, T(0.0));
    for_each_limit(scene.articulation(), x.p[k], [&](int l, const energy::JointLimit<T>& limit) {
      const int contact = scene.limit_contact(l);
      const T force = x.forces[k][contact];
      into.at_joints_[l / 2] = into.at_joints_[l / 2] - force * limit.slope;
      note_gap(k, contact, limit.gap, scene.barrier().window(limit.gap).w);
      if (k == 0) sum.objective = sum.objective + scene.barrier().value(limit.gap);
    });
  }

  bool has_force(int k, int n) const {
    Mask<T> found(false);
    for (int v = 0; v < scene.corners(n); ++v)
      found = found || x.forces[k][energy::contact_of(n, v)] != T(0.0);
    return any(found);
  }

  /// Adds the contacts of pair n at level k. `close` are the lanes in which the bodies are near()
  /// each other. Returns the lanes in which an edge of the second body of the pair separates the
  /// two bodies.
  Mask<T> add_pair(int k, int n, const Mask<T>& close) {
    const bool last = k == problem.sub_steps;
    const energy::PairFrame<T> here = scene.frame(n, x.p[k]);
    const energy::PairFrame<T> ahead = scene.frame(n, x.p[last ? k : k + 1]);
    Vec4<T> own = Vec4<T>::Constant(T(0.0)), next = own;
    energy::SeparatingEdges<T> edges = scene.edges(n);
    for (int v = 0; v < scene.corners(n); ++v) {
      const T force = x.forces[k][energy::contact_of(n, v)];
      const energy::VertexContact<T> contact(scene, n, v, here, close);
      edges.note(contact.distances, scene.real(n, v));
      if (!any(contact.within || force != T(0.0))) continue;
      const SignedDistance<T> d = contact.distance();
      add_contact(k, energy::contact_of(n, v), contact, d);
      own -= contact.point.pulled(d.gradient) * force;
      if (last || !any(force != T(0.0))) continue;
      const energy::SlipTerms<T> s(d.gradient, scene.point(n, v, ahead), contact.point.x,
                                   contact.point.roll, scene.slip());
      next += s.gradient() * (scene.friction(n) * force);
    }
    if (k > 0) pull(scene, n, here, own, into.residuals_[k].data());
    if (!last) pull(scene, n, ahead, next, into.residuals_[k + 1].data());
    return edges.separate(scene.sharpness());
  }

  /// Stores the gap `g` of a contact and updates `legal`. Adds the complementarity residual
  /// λ (g + spare) - μ̃ w to the measures. `window` is w(g).
  void note_gap(int k, int contact, const T& g, const T& window, double spare = 0.0) {
    gaps[k][contact] = g;
    legal = legal && is_gap_acceptable(g, previous_gaps[k][contact], scene.barrier());
    const T off = x.forces[k][contact] * (g + T(spare)) - T(scene.barrier().weight) * window;
    into.complementarity_[k][contact] = off;
    sum.violation = sum.violation + magnitude(off);
    sum.infeasibility = greater(sum.infeasibility, magnitude(off));
  }

  /// Calls note_gap() for the contact of a vertex. At level 0, also adds its barrier to the
  /// objective.
  void add_contact(int k, int index, const energy::VertexContact<T>& contact,
                   const SignedDistance<T>& d) {
    const energy::Barrier& barrier = scene.barrier();
    const Mask<T> acts = contact.within || x.forces[k][index] != T(0.0);
    const T g = contact.gap(d, acts);
    note_gap(k, index, g, select(acts, barrier.window(g).w, T(0.0)),
             k == 0 ? barrier.start_spare() : 0.0);
    if (k == 0) sum.objective = sum.objective + select(contact.within, barrier.value(g), T(0.0));
  }
};

template <class T>
Evaluator<T>::Evaluator(const ProblemLanes<T>& problem, bool all_levels)
    : all_levels_(all_levels),
      residuals_(static_cast<std::size_t>(problem.sub_steps) + 1,
                 std::vector<T>(3 * static_cast<std::size_t>(problem.energy.movable()), T(0.0))),
      complementarity_(residuals_.size(),
                       std::vector<T>(static_cast<std::size_t>(problem.energy.contacts()), T(0.0))),
      at_joints_(problem.energy.articulation().joints().size()) {}

template <class T>
Measures<T> Evaluator<T>::evaluate(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                                   const PerContact<T>& previous_gaps, PerContact<T>& gaps,
                                   Mask<T>& legal) {
  Pass pass{*this, problem, x, previous_gaps, gaps, legal};
  pass.sum.objective = free_objective(problem, x);
  for (int k = 0; k <= problem.sub_steps && (all_levels_ || any(legal)); ++k) {
    if (k < problem.sub_steps) set_free_residual(problem, x, k + 1, residuals_[k + 1].data());
    pass.add_level(k);
    if (k == 0) continue;
    problem.energy.articulation().apply_jacobian_transposed(x.p[k], residuals_[k].data(),
                                                            at_joints_.data());
    for (const T& r : residuals_[k]) {
      pass.sum.violation = pass.sum.violation + magnitude(r);
      pass.sum.infeasibility = greater(pass.sum.infeasibility, magnitude(r));
    }
  }
  return pass.sum;
}

template class Evaluator<double>;
template class Evaluator<Lanes>;

}  // namespace rtg::reverse
