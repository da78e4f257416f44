#pragma once

#include <cmath>
#include <vector>

#include "core/math/elementary.hpp"
#include "core/math/vectors.hpp"

namespace rtg {

/// Planar pose p = (x, y, θ) of a body. A point v in the body frame, whose origin is the centroid,
/// has the world position X(v, p) = R(θ) v + (x, y).
struct Pose {
  double x = 0.0;      // [m]
  double y = 0.0;      // [m]
  double theta = 0.0;  // [rad], never wrapped

  bool operator==(const Pose&) const = default;
  Vector2d position() const { return {x, y}; }
};

/// State of a scene at rest: one pose per body, body 0 is the robot.
using Poses = std::vector<Pose>;

/// Returns the unit vector at the angle θ from the x axis.
inline Vector2d unit(double theta) {
  const Turn<double> turn = turn_of(theta);
  return {turn.c, turn.s};
}

/// Returns R(θ) v.
inline Vector2d rotate(double theta, const Vector2d& v) {
  const auto [c, s] = turn_of(theta);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

/// Returns X(v, p), the world-frame position of a point v in the body frame.
inline Vector2d to_world(const Pose& p, const Vector2d& v) {
  return p.position() + rotate(p.theta, v);
}

/// Returns the body-frame position of a world point `x`: the inverse of to_world().
inline Vector2d to_local(const Pose& p, const Vector2d& x) {
  return rotate(-p.theta, x - p.position());
}

/// Returns `pose` after the rigid motion that takes the pose `from` to `to`.
inline Pose carried(const Pose& pose, const Pose& from, const Pose& to) {
  const double turn = to.theta - from.theta;
  const Vector2d arm = pose.position() - from.position();
  const Vector2d x = to_world({to.x, to.y, turn}, arm);
  return {x.x(), x.y(), pose.theta + to.theta - from.theta};
}

/// Return poses rounded to single precision, in which Box2D computes. Such poses enter Box2D
/// without further rounding.
inline Pose to_single(const Pose& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.theta)};
}

inline Poses to_single(Poses poses) {
  for (Pose& p : poses) p = to_single(p);
  return poses;
}

inline bool is_finite(const Pose& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.theta);
}

inline bool is_finite(const Poses& poses) {
  for (const Pose& p : poses)
    if (!is_finite(p)) return false;
  return true;
}

}  // namespace rtg
