#include "core/reverse/problem/trial_point.hpp"

namespace rtg::reverse {
namespace {

constexpr double kLongestMove = 1.0;  // [m]
constexpr double kLargestTurn = 0.5;  // [rad]
constexpr double kNoForce = 1e-14;    // smaller forces become zero: the contact has opened [kg m]

}  // namespace

template <class T>
Mask<T> bounded(const StageStep<T>& step, const T& alpha) {
  Mask<T> near(true);
  for (const BlockColumn<T>& poses : step.poses)
    for (const Vec3<T>& d : poses)
      near = near &&
             alpha * alpha * (d[0] * d[0] + d[1] * d[1]) <= T(kLongestMove * kLongestMove) &&
             alpha * magnitude(d[2]) <= T(kLargestTurn);
  return near;
}

template <class T>
void make_trial(const energy::SceneModel<T>& scene, const Trajectory<T>& x, const Move<T>& move,
                Trajectory<T>& trial) {
  const T& alpha = move.alpha;
  for (std::size_t k = 0; k < x.p.size(); ++k) {
    scene.advance(x.p[k], move.step.poses[k][0].data(), alpha, trial.p[k]);
    if (k > 0) {
      std::vector<T>& y = trial.multipliers[k];
      y = x.multipliers[k];
      scene.articulation().to_coordinates(x.p[k], y.data());
      const T* step = move.step.multipliers[k][0].data();
      for (std::size_t m = 0; m < y.size(); ++m) y[m] = y[m] + alpha * step[m];
      scene.articulation().apply_jacobian(trial.p[k], y.data());
      trial.controls[k] = x.controls[k] + move.step.controls[k] * alpha;
    }
    for (std::size_t c = 0; c < trial.forces[k].size(); ++c) {
      const T force = x.forces[k][c] + alpha * move.forces[k][c];
      trial.forces[k][c] = select(magnitude(force) < T(kNoForce), T(0.0), force);
    }
  }
}

template Mask<double> bounded(const StageStep<double>&, const double&);
template Mask<Lanes> bounded(const StageStep<Lanes>&, const Lanes&);
template void make_trial(const energy::SceneModel<double>&, const Trajectory<double>&,
                         const Move<double>&, Trajectory<double>&);
template void make_trial(const energy::SceneModel<Lanes>&, const Trajectory<Lanes>&,
                         const Move<Lanes>&, Trajectory<Lanes>&);

}  // namespace rtg::reverse
