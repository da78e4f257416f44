#pragma once

#include "core/energy/step_energy.hpp"

namespace rtg {

/// What an object pays for the way that it makes in one sub-step, (Δt, Δθ), in units of the robot's
/// own way s = stride/h:
///
///   χ q³,   q = (|Δt|² + (J/m) Δθ²) / (2 s²)
///
/// convex, next to nothing up to the robot's speed (q = ½), a wall beyond twice that. Departs from
/// the paper: contact is felt only at the ends of sub-steps, and without it the optimiser finds
/// trajectories on which a thin body steps over the robot.
struct SpeedPenalty {
  double value = 0.0;
  Vector3d gradient = Vector3d::Zero();  // with respect to (Δt, Δθ)
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

inline SpeedPenalty speed_penalty(double weight, double stride, const Damping& body,
                                  const Vector3d& way) {
  const Vector3d metric = Vector3d(1.0, 1.0, body.moment / body.mass) / (2.0 * stride * stride);
  const Vector3d slope = 2.0 * metric.cwiseProduct(way);  // ∂q
  const double q = way.dot(metric.cwiseProduct(way));
  SpeedPenalty penalty{weight * q * q * q, 3.0 * weight * q * q * slope, {}};
  penalty.hessian = 6.0 * weight * q * slope * slope.transpose();
  penalty.hessian.diagonal() += 6.0 * weight * q * q * metric;
  return penalty;
}

}  // namespace rtg
