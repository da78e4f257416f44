#pragma once

#include "core/energy/damping.hpp"
#include "core/math/block_matrix.hpp"

namespace rtg::reverse {

/// The penalty on the motion (Δt, Δθ) of an object in one sub-step. It compares the motion with the
/// distance s = stride/h that the robot moves:
///
///   χ q³,   q = (|Δt|² + (J/m) Δθ²) / (2 s²)
///
/// The penalty is convex, negligible up to the robot's speed (q = ½), and steep beyond twice that
/// speed.
///
/// Departs from the paper: it has no such term. Contact acts only at the ends of sub-steps. Without
/// the penalty the optimiser finds trajectories on which a thin body jumps over the robot, drags
/// objects by 1.1 to 1.2 times the way of the push in the median, and finds 85 of 100 pushes of
/// ArtManip (with it: 98).
template <class T>
struct SpeedPenalty {
  T value;
  Vec3<T> gradient;  // with respect to (Δt, Δθ)
  Block<T> hessian;

  SpeedPenalty(double weight, double stride, const energy::Damping<T>& body,
               const Vec3<T>& displacement) {
    const T scale(1.0 / (2.0 * stride * stride)), w(weight);
    const Vec3<T> metric(scale, scale, scale * body.moment / body.mass);
    Vec3<T> slope;  // ½ ∂q
    for (int m = 0; m < 3; ++m) slope[m] = metric[m] * displacement[m];
    const T q = displacement.dot(slope);
    value = w * q * q * q;
    gradient = slope * (T(6.0) * w * q * q);
    hessian = (slope * (T(24.0) * w * q)) * slope.transpose();
    for (int m = 0; m < 3; ++m) hessian(m, m) += T(6.0) * w * q * q * metric[m];
  }
};

}  // namespace rtg::reverse
