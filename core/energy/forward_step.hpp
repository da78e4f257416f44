#pragma once

#include "core/energy/step_potential.hpp"
#include "core/math/block_ldl.hpp"

namespace rtg::energy {

/// Returns the error scale s of the robot's servo (Drive) for the `stride` of a sub-step [m]. The
/// same number serves as [m] for x and y and as [rad] for θ.
inline double servo_scale(double stride) { return 0.05 * stride; }

/// Actuation of the robot in a sub-step: a given control c, or a bounded servo towards a target
/// pose. The servo's potential is B s ln cosh(e/s). Its error e = target - p₊₀ is measured from the
/// robot's pose p₊₀ after the sub-step. Its force B tanh(e/s) is that of the control c = e/s.
template <class T>
struct Drive {
  bool servo = false;
  Vec3<T> control;  // c, the argument of tanh; or the target pose of the servo [m], [m], [rad]

  static Drive controls(const Vec3<T>& c) { return {false, c}; }
  static Drive towards(const Vec3<T>& target) { return {true, target}; }

  /// Returns the control c when the robot is at its pose in `at`. `scale` is s.
  Vec3<T> control_at(const Placement<T>& at, double scale) const {
    if (!servo) return control;
    Vec3<T> c;
    for (int m = 0; m < 3; ++m) c[m] = (control[m] - at.p[m]) * T(1.0 / scale);
    return c;
  }
};

/// Initial data of a sub-step.
template <class T>
struct StepStart {
  const Placement<T>& now;               // poses, with positive gaps
  const T* previous_forces;              // normal forces at `now` [contacts]
  const T* guess = nullptr;              // expected motion [3·movable]; null if there is none
  const Placement<T>* before = nullptr;  // poses one sub-step earlier, for inertia; null: at rest
};

/// Solves a sub-step, eq. (5): p₊ = argmin Ψ(·, p) under a drive. Uses Newton's method with line
/// search.
template <class T>
class ForwardStep {
 public:
  /// solve() iterates until ‖∂Ψ/∂p₊‖∞ < `tolerance` [kg m]; with joints, until the same holds in
  /// reduced coordinates (Articulation). `scene` must outlive this object.
  ForwardStep(const SceneModel<T>& scene, double tolerance);

  /// Solves the sub-step in the lanes `wanted` and writes p₊ to `next`. Returns the lanes in which
  /// Newton's method converged; `next` is undefined in the others.
  Mask<T> solve(const StepStart<T>& start, const Drive<T>& drive, const Mask<T>& wanted,
                Placement<T>& next);

 private:
  T value(const Placement<T>& at, const Drive<T>& drive, Mask<T>& legal);
  void take_guess(const Drive<T>& drive, const T* guess, Placement<T>& p, T& value);
  Mask<T> converged(Mask<T>& pending) const;
  void linearise(const Placement<T>& at, const Drive<T>& drive);
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
