#include "core/energy/implicit_step.hpp"

namespace rtg {
namespace {

constexpr double kTolerance = 1e-10;  // [kg m]

}  // namespace

std::optional<ImplicitStep> implicit_step(const StepEnergy& energy, const VectorXd& now,
                                          const VectorXd& lag, const Drive<double>& drive) {
  ForwardStep<double> step(energy.scene(), kTolerance);
  const Placement<double> start = placed(now);
  const std::vector<double> forces = energy.spread(lag);
  Placement<double> next;
  if (!step.solve({start, forces.data()}, drive, true, next)) return std::nullopt;
  const Eigen::Map<const VectorXd> end(next.p.data(), now.size());
  return ImplicitStep{end, drive.control_at(next, servo_scale(energy.stride()))};
}

}  // namespace rtg
