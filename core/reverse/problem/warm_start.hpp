#pragma once

#include <optional>

#include "core/energy/forward_step.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// Computes feasible initial iterates of the SQP.
template <class T>
class WarmStart {
 public:
  /// `problem` must outlive the WarmStart.
  explicit WarmStart(const ProblemLanes<T>& problem);

  /// Sets `x`, in the lanes `wanted`, to a push that ends near the final state. Returns the lanes
  /// in which it succeeded. With F, the map of a forward step,
  ///
  ///   - mirrored steps p_{k-1} = p_k - (F(p_k) - p_k) go back from the final state to a start p_0,
  ///   - a forward simulation from p_0 gives `x`.
  ///
  /// In a mirrored step, contacts drag the objects back against the push. An object that stands in
  /// the robot's way back is pushed out of it. Solving F(p_{k-1}) = p_k instead would end nearer to
  /// the final state, but in worse minima of the SQP.
  ///
  /// Departs from the paper: its SQP starts with everything at rest in the final state, A.2, from
  /// where it has to find out which objects the robot can drag. This start drags them already and,
  /// as a simulation, violates no constraint but a fixed final state.
  Mask<T> find(const Mask<T>& wanted, Trajectory<T>& x);

  /// Sets `x`, in the lanes `wanted`, to the forward simulation of the push from its start p_0,
  /// with multipliers 0. Returns the lanes in which it succeeded; in all others `x` becomes
  /// undefined.
  Mask<T> simulate(const Mask<T>& wanted, Trajectory<T>& x);

 private:
  T servo_lead() const;
  Vec3<T> straight_target(int k) const;
  Mask<T> push(const energy::StepStart<T>& from, const Vec3<T>& target, const Mask<T>& wanted,
               energy::Placement<T>& to);
  Mask<T> is_open(const energy::Placement<T>& at, const T& floor) const;
  void clear_way(const Vec3<T>& back, const T& floor, const Mask<T>& wanted);
  void move_back(const T& floor, const Mask<T>& wanted);
  Vec3<T> mirrored_path(int k) const;
  Mask<T> begin_at(int k, const Mask<T>& wanted);
  Mask<T> step_back(int k, const Mask<T>& wanted);
  Mask<T> roll_out(const Mask<T>& wanted, Trajectory<T>& x);

  const ProblemLanes<T>& problem_;
  const energy::SceneModel<T>& scene_;
  energy::ForwardStep<T> step_;
  energy::Placement<T> start_, pushed_, unpushed_, robot_back_, trial_;
  std::vector<T> forward_displacement_;  // move_back() moves the objects by its negative
  std::vector<T> forces_;                // at start_
  std::vector<T> last_displacement_;     // in the last step; guess for the next
};

/// Returns the warm start of one problem, or nothing if a forward step fails.
std::optional<Iterate> warm_start(const ReverseProblem& problem);

}  // namespace rtg::reverse
