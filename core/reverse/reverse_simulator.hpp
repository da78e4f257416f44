#pragma once

#include <span>
#include <vector>

#include "core/reverse/candidate.hpp"
#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/reverse_job.hpp"
#include "core/world/physics_config.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// The reverse rigid-body simulator, eq. (6) and (7): finds the states from which a push leads to a
/// given state. It has no mutable state, so equal jobs give bit-equal results on any thread.
class ReverseSimulator {
 public:
  /// `scene` must have legal shapes only (polygon_defect() empty) and a movable bodies[0].
  ReverseSimulator(Scene scene, const PhysicsConfig& physics, const PushConfig& push,
                   const ReverseConfig& config);

  /// Solves one job. `job.end` is a state at rest with one pose per body. Bodies that the push
  /// cannot reach keep their poses; with the plain barrier, whose range is infinite, the push
  /// reaches all bodies. Never throws. The status is kNonFinite also if `job.end` has the wrong
  /// size or a pose that is not finite.
  [[nodiscard]] ReverseResult solve(const ReverseJob& job) const;
  /// Solves many jobs together, which takes much less time than one after the other. The results
  /// do not depend, to the bit, on which jobs are solved together.
  [[nodiscard]] std::vector<ReverseResult> solve(std::span<const ReverseJob> jobs) const;

 private:
  ReverseResult answer(const ReverseJob& job, const Candidate& candidate,
                       const SqpResult& solved) const;

  Scene scene_;
  PhysicsConfig physics_;
  PushConfig push_;
  ReverseConfig config_;
};

}  // namespace rtg::reverse
