#pragma once

#include <optional>

#include "core/energy/forward_step.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// Feasible starts of the SQP.
template <class T>
class WarmStart {
 public:
  /// The problem must outlive it.
  explicit WarmStart(const ProblemLanes<T>& problem);

  /// A forward simulation that ends near the final state, from mirrored forward steps: against a
  /// push the contacts drag, p_{k-1} = p_k - (F(p_k) - p_k). Corrections towards F(p_{k-1}) = p_k
  /// would end nearer, but in worse minima. Returns the lanes in which it succeeded.
  Mask<T> find(const Mask<T>& wanted, Trajectory<T>& x);

 private:
  Vec3<T> straight_target(int k) const;
  Mask<T> push(const energy::StepStart<T>& from, const Vec3<T>& target, const Mask<T>& wanted,
               energy::Placement<T>& to);
  void move_back(const energy::Placement<T>& p, const Mask<T>& wanted, energy::Placement<T>& out);
  Vec3<T> mirrored_path(int k) const;
  Mask<T> begin_at(int k, const Mask<T>& wanted);
  Mask<T> mirror(int k, const Mask<T>& wanted);
  Mask<T> roll_out(const Mask<T>& wanted, Trajectory<T>& x);

  const ProblemLanes<T>& problem_;
  const energy::SceneModel<T>& scene_;
  energy::ForwardStep<T> step_;
  energy::Placement<T> start_, pushed_, still_, robot_back_, trial_;
  std::vector<T> by_, lag_, moved_;  // moved_: by the push last solved, a guess for the next
};

/// The start of one candidate. Nothing if a step fails.
std::optional<Iterate> warm_start(const ReverseProblem& problem);

}  // namespace rtg::reverse
