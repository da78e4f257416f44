#include "core/energy/open_gaps.hpp"

#include <utility>

#include "core/energy/joint_limit.hpp"
#include "core/energy/scatter.hpp"
#include "core/energy/vertex_contact.hpp"

namespace rtg::energy {
namespace {

constexpr int kRounds = 50;
constexpr double kLeastShare = 0.01;  // least |Jᵀ∇g|²/|∇g|²; below it the joints hold the gap

/// Moves the bodies so that a gap grows by `amount`, to first order. `gradient` is ∇g [3·movable].
/// Does nothing if the joints permit almost no motion that opens the gap.
void open_by(const SceneModel<double>& scene, double amount, VectorXd gradient,
             Placement<double>& at) {
  const double free = gradient.squaredNorm();
  scene.articulation().apply_jacobian_transposed(at, gradient.data());
  const double size = gradient.squaredNorm();
  if (size < kLeastShare * free) return;
  for (Eigen::Index m = 0; m < gradient.size(); ++m)
    at.p[static_cast<std::size_t>(m)] += amount / size * gradient[m];
  scene.place(at);
}

/// Moves the bodies of pair `n` apart where a gap is below `floor`. Returns whether there was such
/// a gap.
bool open_pair(const SceneModel<double>& scene, int n, double floor, Placement<double>& at) {
  bool opened = false;
  for (int v = 0; v < scene.corners(n); ++v) {
    const PairFrame<double> frame = scene.frame(n, at);
    const VertexContact<double> contact(scene, n, v, frame, true);
    if (!contact.within) continue;
    const SignedDistance<double> d = contact.distance();
    const double gap = contact.gap(d, true);
    if (gap >= floor) continue;
    VectorXd slope = VectorXd::Zero(3 * scene.movable());
    pull(scene, n, frame, contact.point.pulled(d.gradient), slope.data());
    open_by(scene, 1.1 * floor - gap, std::move(slope), at);
    opened = true;
  }
  return opened;
}

/// Opens the gaps of joint limits that are below `floor`. Returns whether there was such a gap.
bool open_limits(const SceneModel<double>& scene, double floor, Placement<double>& at) {
  bool opened = false;
  const Placement<double> was = at;
  for_each_limit(scene.articulation(), was, [&](int, const JointLimit<double>& limit) {
    if (limit.gap >= floor) return;
    VectorXd slope = VectorXd::Zero(3 * scene.movable());
    limit.add_gradient(1.0, scene.movable(), slope.data());
    open_by(scene, 1.1 * floor - limit.gap, std::move(slope), at);
    opened = true;
  });
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
  scene.place(at);
  bool open = false;
  for (int round = 0; round < kRounds && !open; ++round) {
    open = !open_limits(scene, floor, at);
    for (int n = 0; n < scene.pair_count(); ++n)
      if (scene.near(n, at) && open_pair(scene, n, floor, at)) open = false;
  }
  return Eigen::Map<const VectorXd>(at.p.data(), p.size());
}

}  // namespace rtg::energy
