#pragma once

#include <vector>

#include "core/energy/contact_point.hpp"
#include "core/math/block_tridiagonal.hpp"
#include "core/math/rng.hpp"
#include "core/math/vectors.hpp"
#include "core/world/pose.hpp"

namespace rtg::testing {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Sharpness at which the samples' corners are rounded.
inline constexpr double kAlpha = 50.0;

/// A vertex in its body's frame, and the box that it comes near.
inline const Vector2d kVertex(0.5, -0.3);
inline const HalfPlanes kBox = half_planes(box(1.2, 1.2));

/// Points in the frame of a box of half width 0.6: on faces, beside and right at corners, near
/// contact (gaps of 1e-4 to 0.1) and, for the smoothed distance has no gap in its domain, inside.
inline std::vector<Vector2d> points_near_a_box() {
  return {{0.6001, 0.2}, {0.605, -0.3},  {0.7, 0.0},      {-0.3, 0.61},   {0.62, 0.59},
          {0.6, 0.6},    {0.595, 0.595}, {-0.604, 0.598}, {0.61, -0.601}, {0.55, 0.1}};
}

/// Poses (p_i, p_j) [6] at random such that `vertex` of body i stands at `x` in body j's frame.
inline Vec6 poses_with_point_at(const Vector2d& vertex, const Vector2d& x, Rng& rng) {
  const Pose j{rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0), rng.uniform(-3.0, 3.0)};
  const double theta = rng.uniform(-3.0, 3.0);
  const Vector2d at = to_world(j, x) - rotate(theta, vertex);
  Vec6 q;
  q << at, theta, j.x, j.y, j.theta;
  return q;
}

/// The poses after a rigid motion of the scene: turned by `angle` about the origin, then shifted.
inline Vec6 rigidly_moved(const Vec6& q, double angle, const Vector2d& shift) {
  Vec6 moved;
  for (int body = 0; body < 2; ++body)
    moved.segment<3>(3 * body) << rotate(angle, q.segment<2>(3 * body)) + shift,
        q[3 * body + 2] + angle;
  return moved;
}

/// Net force and net torque about the origin of forces g on two bodies at q: both 0 for
/// anything invariant under rigid motions.
inline Eigen::Vector3d net_wrench(const Vec6& g, const Vec6& q) {
  Eigen::Vector3d net = g.head<3>() + g.tail<3>();
  for (const int at : {0, 3}) net[2] += q[at] * g[at + 1] - q[at + 1] * g[at];
  return net;
}

inline energy::PairFrame<double> frame_of(const VectorXd& q) {
  return {q.data(), turn_of(q[2]), q.data() + 3, turn_of(q[5])};
}

/// V of PairFrame [4 × 6], by its effect on the unit vectors.
inline Eigen::Matrix<double, 4, 6> pushing(const energy::PairFrame<double>& frame) {
  Eigen::Matrix<double, 4, 6> V;
  for (int m = 0; m < 6; ++m) {
    const Vec6 unit = Vec6::Unit(m);
    V.col(m) = frame.pushed(unit.data(), unit.data() + 3);
  }
  return V;
}

}  // namespace rtg::testing
