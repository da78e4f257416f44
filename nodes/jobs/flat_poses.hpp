#pragma once

#include <cstddef>
#include <vector>

#include "core/world/pose.hpp"

namespace rtg::jobs {

/// Appends a state to a flat array: x, y, θ of each body.
inline void append_poses(const Poses& poses, std::vector<double>& out) {
  for (const Pose& p : poses) out.insert(out.end(), {p.x, p.y, p.theta});
}

/// Returns state number `i` of a flat array of states.
inline Poses poses_at(const std::vector<double>& numbers, std::size_t i, int bodies) {
  Poses poses(static_cast<std::size_t>(bodies));
  const double* p = numbers.data() + i * poses.size() * 3;
  for (Pose& pose : poses) {
    pose = {p[0], p[1], p[2]};
    p += 3;
  }
  return poses;
}

}  // namespace rtg::jobs
