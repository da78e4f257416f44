#include "core/energy/open_gaps.hpp"

#include "core/energy/touch.hpp"

namespace rtg {
namespace {

constexpr int kRounds = 50;

/// Moves the bodies of a pair apart where gaps are below the floor; whether there was one.
bool open_pair(const SceneModel<double>& scene, int n, double floor, Placement<double>& at) {
  bool opened = false;
  const auto [i, j] = scene.pairs()[n];
  for (int v = 0; v < scene.corners(n); ++v) {
    const PairFrame<double> frame = scene.frame(n, at);
    const Touch<double> touch(scene, n, v, frame, true);
    if (!touch.within) continue;
    const SignedDistance<double> d = touch.distance();
    const double gap = d.value - scene.skin();
    if (gap >= floor) continue;
    Vector3d slope[2] = {Vector3d::Zero(), Vector3d::Zero()};
    frame.pull(touch.point.pulled(d.gradient), scene.movable(i) ? slope[0].data() : nullptr,
               scene.movable(j) ? slope[1].data() : nullptr);
    const double step = (1.1 * floor - gap) / (slope[0].squaredNorm() + slope[1].squaredNorm());
    for (int m = 0; m < 3; ++m) {
      at.body(i)[m] += step * slope[0][m];
      at.body(j)[m] += step * slope[1][m];
    }
    at.update();
    opened = true;
  }
  return opened;
}

}  // namespace

double least_gap(const StepEnergy& energy, const VectorXd& p) {
  return energy.scene().least_gap(placed(p));
}

VectorXd with_open_gaps(const StepEnergy& energy, const VectorXd& p) {
  const SceneModel<double>& scene = energy.scene();
  const double floor = kGapFloor * energy.barrier().range;
  Placement<double> at = placed(p);
  bool open = false;
  for (int round = 0; round < kRounds && !open; ++round) {
    open = true;
    for (int n = 0; n < scene.pair_count(); ++n)
      if (scene.near(n, at) && open_pair(scene, n, floor, at)) open = false;
  }
  return Eigen::Map<const VectorXd>(at.p.data(), p.size());
}

}  // namespace rtg
