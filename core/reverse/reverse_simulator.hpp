#pragma once

#include <span>
#include <vector>

#include "core/reverse/candidate.hpp"
#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/reverse_job.hpp"
#include "core/reverse/problem/reverse_model.hpp"
#include "core/world/physics_config.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg::reverse {

/// The reverse rigid-body simulator, eq. (6) and (7): finds the states from which a push leads to a
/// given state. Equal jobs give bit-equal results on any thread, as the simulator has no mutable
/// state.
class ReverseSimulator {
 public:
  /// Every shape of `scene` must be legal (polygon_defect() is empty). bodies[0], the robot, must
  /// be movable.
  ReverseSimulator(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push,
                   const ReverseConfig& config);

  /// Finds states from which `job.action` leads to `job.end`, a state at rest with one pose per
  /// body. Bodies that the push cannot reach keep their poses. With the plain barrier the push
  /// reaches all bodies, as contact forces have infinite range. Never throws. The status is
  /// kNonFinite if `job.end` has the wrong size or is not finite.
  [[nodiscard]] ReverseResult solve(const ReverseJob& job) const;
  /// Solves many jobs together, in much less time than one by one. Each result is bit-equal to that
  /// of solve(job).
  [[nodiscard]] std::vector<ReverseResult> solve(std::span<const ReverseJob> jobs) const;

 private:
  ReverseResult answer(const ReverseJob& job, const Candidate& candidate,
                       const SqpResult& solved) const;

  ReverseModel model_;
  PushConfig push_;
  ReverseConfig config_;
  double newton_;  // of the forces in a problem, k_D/Δt² [N/(kg m)]
};

}  // namespace rtg::reverse
