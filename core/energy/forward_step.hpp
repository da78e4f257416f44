#pragma once

#include "core/energy/step_potential.hpp"
#include "core/math/block_ldl.hpp"

namespace rtg::energy {

/// Returns the scale s of the servo's error for a sub-step's stride [m]; the same number in [m] for
/// x and y and in [rad] for θ.
inline double servo_scale(double stride) { return 0.05 * stride; }

/// The drive of the robot in a sub-step: given controls, or a bounded servo towards a target pose.
/// The servo has the potential B s ln cosh(e/s) of the error e = target - p₊₀. Its force
/// B tanh(e/s) equals that of the control c = e/s.
template <class T>
struct Drive {
  bool servo = false;
  Vec3<T> control;  // c, the argument of tanh; or the target pose of the servo [m], [m], [rad]

  static Drive controls(const Vec3<T>& c) { return {false, c}; }
  static Drive towards(const Vec3<T>& target) { return {true, target}; }

  /// Returns c at the robot's pose; `scale` is s.
  Vec3<T> control_at(const Placement<T>& at, double scale) const {
    if (!servo) return control;
    Vec3<T> c;
    for (int m = 0; m < 3; ++m) c[m] = (control[m] - at.p[m]) * T(1.0 / scale);
    return c;
  }
};

/// Start of a sub-step.
template <class T>
struct StepStart {
  const Placement<T>& now;               // poses, with positive gaps
  const T* lag;                          // normal forces at `now` [contacts]
  const T* guess = nullptr;              // expected motion [3·movable]; null if there is none
  const Placement<T>* before = nullptr;  // poses one sub-step earlier, for inertia; null: at rest
};

/// Solver of a sub-step, eq. (5): p₊ = argmin Ψ(·, p) under a drive, by Newton's method with line
/// search.
template <class T>
class ForwardStep {
 public:
  /// solve() has converged if ‖∂Ψ/∂p₊‖∞ < tolerance [kg m]. `scene` must outlive this object.
  ForwardStep(const SceneModel<T>& scene, double tolerance);

  /// Returns the lanes of `wanted` in which Newton's method converged. `next` is p₊ in these lanes
  /// and undefined in the others.
  Mask<T> solve(const StepStart<T>& start, const Drive<T>& drive, const Mask<T>& wanted,
                Placement<T>& next);

 private:
  T value(const Placement<T>& at, const Drive<T>& drive, Mask<T>& legal);
  void take_guess(const Drive<T>& drive, const T* guess, Placement<T>& p, T& value);
  Mask<T> converged(Mask<T>& pending) const;
  void linearise(const Placement<T>& at, const Drive<T>& drive);
  void reduce(const Placement<T>& at);
  Mask<T> find_direction(Mask<T> wanted);
  Mask<T> line_search(const Drive<T>& drive, const Mask<T>& wanted, Placement<T>& p, T& value);
  void accept(const Mask<T>& better, Placement<T>& p);

  const SceneModel<T>& scene_;
  double tolerance_;
  StepPotential<T> potential_;
  BlockColumn<T> gradient_, direction_;
  BlockMatrix<T> hessian_;
  BlockLdl<T> factor_;
  Placement<T> trial_;
  std::vector<T> gaps_, trial_gaps_;  // [contacts]
};

}  // namespace rtg::energy
