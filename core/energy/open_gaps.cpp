#include "core/energy/open_gaps.hpp"

#include <numeric>
#include <vector>

#include "core/energy/joint_limit.hpp"
#include "core/energy/scatter.hpp"
#include "core/energy/vertex_contact.hpp"

namespace rtg::energy {
namespace {

constexpr int kRounds = 50;
constexpr double kLeastShare = 0.01;  // least |Jᵀ∇g|²/|∇g|²; below it the joints hold the gap

/// Returns |v|², summed in order. Eigen's order depends on the size of the processor's registers.
double square(const VectorXd& v) { return std::inner_product(v.begin(), v.end(), v.begin(), 0.0); }

/// Moves the bodies so that a gap grows by `amount`, to first order. `gradient` is ∇g over the
/// coordinates [3·movable].
void open_by(const SceneModel<double>& scene, double amount, const VectorXd& gradient,
             Placement<double>& at) {
  const Placement<double> from = at;
  scene.advance(from, gradient.data(), amount / square(gradient), at);
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
    opened = true;
    const double free = square(slope);
    scene.articulation().apply_jacobian_transposed(at, slope.data());
    if (square(slope) >= kLeastShare * free) open_by(scene, 1.1 * floor - gap, slope, at);
  }
  return opened;
}

/// Opens the gaps of joint limits that are below `floor`. Returns whether there was such a gap.
bool open_limits(const SceneModel<double>& scene, double floor, Placement<double>& at) {
  bool opened = false;
  const Placement<double> was = at;
  const Articulation<double>& articulation = scene.articulation();
  for_each_limit(articulation, was, [&](int l, const JointLimit<double>& limit) {
    if (limit.gap >= floor) return;
    VectorXd slope = VectorXd::Zero(3 * scene.movable());
    std::vector<double> at_joints(articulation.joints().size(), 0.0);
    at_joints[static_cast<std::size_t>(l / 2)] = limit.slope;
    articulation.apply_jacobian_transposed(at, slope.data(), at_joints.data());
    open_by(scene, 1.1 * floor - limit.gap, slope, at);
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
