#pragma once

#include "core/math/stage_system.hpp"
#include "core/reverse/problem/contact_linearisation.hpp"
#include "core/reverse/problem/limit_linearisation.hpp"

namespace rtg::reverse {

/// The Newton system of the first-order conditions, eq. (9) and (10), with one stage per sub-step.
/// It contains no normal forces. The complementarity row of a contact,
///
///   g Δλ + s ∇g·Δp = -(λ g - μ̃ w),  s = λ - μ̃ w'   =>   Δλ = a + b·Δp,
///
/// eliminates the step of its force. Stationarity in λ gives the multiplier of the row, z = -L_λ/g.
/// At the start g + g_s takes the place of g (Barrier::start_spare()). The contacts of a pair of
/// bodies are summed in the coordinates of the pair (PairFrame).
///
/// Departs from the paper: its contact force is a function of the poses, μ̃/g. Kept as an unknown
/// with the row λ g = μ̃ w, it makes the constraints bilinear, without 1/g. On the scenes of a
/// prototype, not of this code, IPOPT failed on the printed form in 9 of 10, and solved 8 to 9 of
/// 10 with the row.
template <class T>
class NewtonSystem {
 public:
  explicit NewtonSystem(const ProblemLanes<T>& problem);

  void linearise(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                 const Curvature<T>& curvature);

  const StageSystem<T>& system() const { return system_; }
  /// Returns the gradient of the Lagrangian after elimination of the forces [h + 1][movable]. With
  /// joints it is over the reduced coordinates (Articulation), otherwise over the poses.
  const std::vector<BlockColumn<T>>& gradient() const { return gradient_; }
  /// Returns ‖∇L‖∞ over poses and controls. It is NaN in lanes in which ∇L is not finite.
  T stationarity() const;

  /// Computes the steps Δλ of the forces that belong to `step`, into `out` [h + 1][contacts].
  void force_steps(const ProblemLanes<T>& problem, const Trajectory<T>& x, const StageStep<T>& step,
                   PerContact<T>& out) const;

  /// Returns sᵀ H s, the curvature of the quadratic model along s = `step`. `step` must solve the
  /// system.
  T model_curvature(const StageStep<T>& step) const;
  /// Returns ∇J·s, the slope of the objective along s = `step`. `step` must solve the system.
  T objective_slope(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                    const StageStep<T>& step) const;

 private:
  using Stage = typename StageSystem<T>::Stage;
  void set_objective(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k);
  void add_motion(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k);
  void add_inertia(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k);
  void add_turn_curvature(const typename energy::Inertia<T>::Slope& s, const T& y, int k, int i);
  void add_control(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k);
  void add_pair(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k, int n);
  void set_limits(const ProblemLanes<T>& problem, const Trajectory<T>& x, int k);
  void find_force_steps(const energy::SceneModel<T>& scene, const energy::Placement<T>& at, int k,
                        const T* moved, T* out) const;
  void add_own(const energy::SceneModel<T>& scene, int pair, const energy::PairFrame<T>& frame,
               const PairTerms<T>& terms, int k);

  bool fixed_end_;
  Curvature<T> curvature_;
  StageSystem<T> system_;
  std::vector<BlockColumn<T>> gradient_;  // of the Lagrangian, forces eliminated
  std::vector<BlockColumn<T>> residual_;  // Φ_k
  std::vector<Vec3<T>> control_gradient_;
  std::vector<std::vector<Eliminated<T>>> eliminated_;  // [h + 1][contacts]
  std::vector<std::vector<LimitTerms<T>>> limits_;      // [h + 1][joints]
  std::vector<std::vector<char>> active_;               // [h + 1][pairs]
  mutable BlockColumn<T> moved_;                        // workspace
};

}  // namespace rtg::reverse
