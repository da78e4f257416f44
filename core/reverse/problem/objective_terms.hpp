#pragma once

#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

// The terms of the objective J of eq. (6), each with its derivatives. The two other terms are
// SpeedPenalty and, at the start, Barrier.

/// The term w_i d·(t_i - t̄_i), which pulls the start of body i against the push. t_i is its
/// position in p_0, t̄_i that in the final state.
template <class T>
struct StartTerm {
  T value;
  Vec3<T> gradient;

  StartTerm(const ProblemLanes<T>& problem, const energy::Placement<T>& start, int i) {
    const T weight(i == 0 ? problem.config.robot_weight : problem.config.object_weight);
    const T dx = start.body(i)[0] - problem.end[3 * i],
            dy = start.body(i)[1] - problem.end[3 * i + 1];
    value = weight * (problem.direction.x() * dx + problem.direction.y() * dy);
    gradient = {weight * problem.direction.x(), weight * problem.direction.y(), T(0.0)};
  }
};

/// The term ε |c|² of the controls of one sub-step.
template <class T>
struct ControlPenalty {
  T value;
  Vec3<T> gradient;
  T hessian;  // the same for each control

  ControlPenalty(const ProblemLanes<T>& problem, const Vec3<T>& controls)
      : value(T(problem.config.control_weight) * controls.squaredNorm()),
        hessian(2.0 * problem.config.control_weight) {
    gradient = controls * hessian;
  }
};

/// The terms κ_x |t₀ - t̄₀|² and κ_θ (θ₀ - θ̄₀)². They hold the robot on its straight path
/// (t̄₀, θ̄₀) after sub-step k.
///
/// Departs from the paper: eq. (6) says nothing of how the robot moves, but the action is a
/// straight push by one stride. Without these terms the solver drags objects in 259 of 300 states
/// after true pushes, and in none does the push lead back (with them: in 298).
template <class T>
struct PathPenalty {
  T position, heading;        // values of the two terms
  Vec3<T> gradient, hessian;  // the Hessian is diagonal

  PathPenalty(const ProblemLanes<T>& problem, const energy::Placement<T>& at, int k) {
    const Vec3<T> path = problem.robot_path(k);
    const T *robot = at.body(0), dx = robot[0] - path[0], dy = robot[1] - path[1],
            turn = robot[2] - path[2];
    position = T(problem.config.path_weight) * (dx * dx + dy * dy);
    heading = T(problem.config.heading_weight) * turn * turn;
    const T by_position(2.0 * problem.config.path_weight),
        by_heading(2.0 * problem.config.heading_weight);
    hessian = {by_position, by_position, by_heading};
    gradient = {by_position * dx, by_position * dy, by_heading * turn};
  }
};

/// The term K/2 |p_k - p̄|² over all movable bodies: a spring to the final state p̄. It acts on the
/// poses p_k for which ProblemLanes::is_terminal(k).
///
/// Departs from the paper: it fixes the final state. Not all rest states of Box2D have a
/// predecessor then: of 300 true pushes 240 are found (with the spring: 298). With it every forward
/// simulation is feasible. With K = 0 the final state is fixed here, too, but with inertia p_h
/// alone, where eq. (7) fixes p_{h-1} as well: damping divides speed by 1 + k_D per sub-step, so
/// that a body that was pushed never stands quite still. It moves by 0.8 % of a stride in the last
/// sub-step (FilterSqpInertia).
template <class T>
class EndSpring {
 public:
  EndSpring(const ProblemLanes<T>& problem, const energy::Placement<T>& at, int k)
      : hessian(k > 0 && problem.is_terminal(k) ? problem.config.terminal_weight : 0.0),
        problem_(problem),
        at_(at) {}

  T value() const {
    T miss(0.0);
    for (int m = 0; m < 3 * problem_.energy.movable(); ++m) {
      const T off = at_.p[m] - problem_.end[m];
      miss = miss + off * off;
    }
    return T(0.5) * hessian * miss;
  }
  T gradient(int i, int m) const { return hessian * (at_.body(i)[m] - problem_.end[3 * i + m]); }

  T hessian;  // K, the same for each coordinate; 0 where the spring does not act

 private:
  const ProblemLanes<T>& problem_;
  const energy::Placement<T>& at_;
};

}  // namespace rtg::reverse
