#include "core/energy/forward_step.hpp"

#include <algorithm>
#include <numbers>

namespace rtg::energy {
namespace {

constexpr int kMaxIterations = 100;
constexpr double kArmijo = 1e-4;
constexpr double kLeastStep = 1e-12;
constexpr double kLargestShift = 1e6;  // in units of the Hessian's largest diagonal entry

template <class T>
T log_cosh(const T& x) {
  const T a = magnitude(x);
  return a + logarithm(T(1.0) + exponential(T(-2.0) * a)) - T(std::numbers::ln2);
}

template <class T>
Mask<T> finite(const T& x) {
  return x - x == T(0.0);
}

}  // namespace

template <class T>
ForwardStep<T>::ForwardStep(const SceneModel<T>& scene, double tolerance)
    : scene_(scene),
      tolerance_(tolerance),
      potential_(scene),
      gradient_(static_cast<std::size_t>(scene.movable())),
      direction_(gradient_),
      hessian_(scene.movable()),
      factor_(scene.movable()),
      trial_(scene.bodies()),
      gaps_(static_cast<std::size_t>(scene.contacts())),
      trial_gaps_(gaps_) {}

/// Returns Ψ including the potential of the drive. Sets `legal` as StepPotential::value() does, and
/// trial_gaps_.
template <class T>
T ForwardStep<T>::value(const Placement<T>& at, const Drive<T>& drive, Mask<T>& legal) {
  T sum = potential_.value(at, gaps_.data(), trial_gaps_.data(), legal);
  const double scale = servo_scale(scene_.stride());
  const Vec3<T> c = drive.control_at(at, scale);
  for (int m = 0; m < 3; ++m)
    sum = sum + scene_.control_bound()[m] *
                    (drive.servo ? T(scale) * log_cosh(c[m]) : -hyperbolic_tangent(c[m]) * at.p[m]);
  return sum;
}

template <class T>
void ForwardStep<T>::linearise(const Placement<T>& at, const Drive<T>& drive) {
  for (Vec3<T>& g : gradient_) g.setConstant(T(0.0));
  hessian_.clear();
  potential_.model(at, gradient_[0].data(), hessian_);
  const double scale = servo_scale(scene_.stride());
  const Vec3<T> c = drive.control_at(at, scale);
  for (int m = 0; m < 3; ++m) {
    const T push = hyperbolic_tangent(c[m]), bound = scene_.control_bound()[m];
    gradient_[0][m] -= bound * push;
    if (drive.servo) hessian_.at(0, 0)(m, m) += bound * (T(1.0) - push * push) * T(1.0 / scale);
  }
  potential_.reduce(at, gradient_[0].data(), hessian_);
}

/// Computes the Newton direction. Where the Hessian is indefinite, adds growing multiples of the
/// identity until it is positive definite. Returns the lanes in which this succeeds.
template <class T>
Mask<T> ForwardStep<T>::find_direction(Mask<T> wanted) {
  T size(0.0), shift(0.0);
  for (int i = 0; i < hessian_.M; ++i)
    for (int m = 0; m < 3; ++m) size = greater(size, magnitude(hessian_.at(i, i)(m, m)));
  for (;;) {
    const Mask<T> indefinite = wanted && !factor_.factorize(hessian_);
    wanted = wanted && !(indefinite && !(shift <= T(kLargestShift) * size));
    if (!any(indefinite && wanted)) break;
    const T more = select(indefinite, greater(T(9.0) * shift, T(1e-6) * size), T(0.0));
    shift = shift + more;
    for (int i = 0; i < hessian_.M; ++i)
      for (int m = 0; m < 3; ++m) hessian_.at(i, i)(m, m) += more;
  }
  for (int i = 0; i < hessian_.M; ++i) direction_[i] = -gradient_[i];
  factor_.solve(direction_.data());
  return wanted;
}

/// Copies trial_ to `p` and trial_gaps_ to gaps_ in the lanes `better`.
template <class T>
void ForwardStep<T>::accept(const Mask<T>& better, Placement<T>& p) {
  p.assign(better, trial_);
  for (std::size_t c = 0; c < gaps_.size(); ++c)
    gaps_[c] = select(better, trial_gaps_[c], gaps_[c]);
}

/// Adds `guess` to `p` in the lanes where the sum is legal and has a lower Ψ than `value`. Updates
/// `value`.
template <class T>
void ForwardStep<T>::take_guess(const Drive<T>& drive, const T* guess, Placement<T>& p, T& value) {
  trial_ = p;
  for (int m = 0; m < 3 * scene_.movable(); ++m) trial_.p[m] = p.p[m] + guess[m];
  scene_.place(trial_);
  Mask<T> legal;
  const T after = this->value(trial_, drive, legal);
  const Mask<T> better = legal && after < value;
  accept(better, p);
  value = select(better, after, value);
}

/// Moves `p` along direction_ in the lanes `wanted` by a backtracking line search. Returns the
/// lanes in which the search found an acceptable point.
template <class T>
Mask<T> ForwardStep<T>::line_search(const Drive<T>& drive, const Mask<T>& wanted, Placement<T>& p,
                                    T& value) {
  T slope(0.0);
  for (int i = 0; i < hessian_.M; ++i) slope = slope + gradient_[i].dot(direction_[i]);
  const T noise = T(1e-15) * (T(1.0) + magnitude(value));
  Mask<T> searching = wanted;
  trial_ = p;
  for (double step = 1.0; step >= kLeastStep && any(searching); step *= 0.5) {
    const T length = select(searching, T(step), T(0.0));
    scene_.advance(p, direction_[0].data(), length, trial_);
    Mask<T> legal;
    const T after = this->value(trial_, drive, legal);
    const Mask<T> better = searching && legal && after <= value + T(kArmijo * step) * slope + noise;
    if (!any(better)) continue;
    accept(better, p);
    value = select(better, after, value);
    searching = searching && !better;
  }
  return wanted && !searching;
}

/// Returns the lanes of `pending` whose gradient is below the tolerance. Removes lanes with a
/// non-finite gradient from `pending`.
template <class T>
Mask<T> ForwardStep<T>::converged(Mask<T>& pending) const {
  T top(0.0), sum(0.0);
  for (const Vec3<T>& g : gradient_)
    for (int m = 0; m < 3; ++m) {
      top = greater(top, magnitude(g[m]));
      sum = sum + g[m];
    }
  pending = pending && finite(sum);
  return pending && top < T(tolerance_);
}

template <class T>
Mask<T> ForwardStep<T>::solve(const StepStart<T>& start, const Drive<T>& drive,
                              const Mask<T>& wanted, Placement<T>& next) {
  next = start.now;
  potential_.begin(start.now, start.previous_forces, start.before);
  std::fill(gaps_.begin(), gaps_.end(), T(0.0));
  Mask<T> legal, there(false);
  T value = this->value(next, drive, legal);
  gaps_ = trial_gaps_;
  Mask<T> pending = wanted && finite(value);
  if (start.guess) take_guess(drive, start.guess, next, value);
  for (int i = 0; i < kMaxIterations && any(pending); ++i) {
    linearise(next, drive);
    const Mask<T> ended = converged(pending);
    there = there || ended;
    pending = pending && !ended;
    if (!any(pending)) break;
    pending = line_search(drive, find_direction(pending), next, value);
  }
  return there;
}

template class ForwardStep<double>;
template class ForwardStep<Lanes>;

}  // namespace rtg::energy
