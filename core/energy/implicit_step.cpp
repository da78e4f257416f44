#include "core/energy/implicit_step.hpp"

namespace rtg::energy {
namespace {

constexpr double kTolerance = 1e-10;  // [kg m]

}  // namespace

std::optional<ImplicitStep> implicit_step(const StepEnergy& energy, const StepFrom& from,
                                          const Drive<double>& drive) {
  ForwardStep<double> step(energy.scene(), kTolerance);
  const Placement<double> now = placed(from.now);
  const Placement<double> before = placed(from.before ? *from.before : from.now);
  const std::vector<double> forces = energy.to_contact_index(from.previous_forces);
  Placement<double> next;
  if (!step.solve({now, forces.data(), nullptr, &before}, drive, true, next)) return std::nullopt;
  const Eigen::Map<const VectorXd> end(next.p.data(), from.now.size());
  return ImplicitStep{end, drive.control_at(next, servo_scale(energy.stride()))};
}

}  // namespace rtg::energy
