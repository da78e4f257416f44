#pragma once

#include "core/energy/step_potential.hpp"
#include "core/math/block_ldl.hpp"

namespace rtg::energy {

/// Scale of the servo's error, as a share of the sub-step's stride [m], [m], [rad].
inline double servo_scale(double stride) { return 0.05 * stride; }

/// The drive of the robot in a sub-step: given controls, or a bounded servo towards a target pose,
/// the potential B s ln cosh(e/s) of the error e = target - p₊₀, whose force B tanh(e/s) is that
/// of the control c = e/s.
template <class T>
struct Drive {
  bool servo = false;
  Vec3<T> control;  // c, before tanh; or the target pose [m], [m], [rad]

  static Drive controls(const Vec3<T>& c) { return {false, c}; }
  static Drive towards(const Vec3<T>& target) { return {true, target}; }

  /// c at the robot's pose.
  Vec3<T> control_at(const Placement<T>& at, double scale) const {
    if (!servo) return control;
    Vec3<T> c;
    for (int m = 0; m < 3; ++m) c[m] = (control[m] - at.p[m]) * T(1.0 / scale);
    return c;
  }
};

/// Where a sub-step begins: the poses, with open gaps, their normal forces [contacts], and, if not
/// null, a guess of how far they will move [3·bodies] and the poses one sub-step before, which
/// inertia asks for; null: at rest.
template <class T>
struct StepStart {
  const Placement<T>& now;
  const T* lag;
  const T* guess = nullptr;
  const Placement<T>* before = nullptr;
};

/// A sub-step, eq. (5): p₊ = argmin Ψ(·, p) under a drive, by Newton's method with
/// line search.
template <class T>
class ForwardStep {
 public:
  /// Ends at ‖∂Ψ/∂p₊‖∞ < tolerance [kg m]. The scene must outlive it.
  ForwardStep(const SceneModel<T>& scene, double tolerance);

  /// Returns in which of the lanes `wanted` it got there; `next` is defined there alone.
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
