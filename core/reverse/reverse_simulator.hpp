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

/// The reverse rigid-body simulator, eq. (6) and (7): from which state does a push lead to a given
/// one? Const and free of mutable state, so equal jobs give bit-equal results on any thread.
class ReverseSimulator {
 public:
  /// `scene`: legal shapes only (polygon_defect() empty), bodies[0] movable.
  ReverseSimulator(Scene scene, const PhysicsConfig& physics, const PushConfig& push,
                   const ReverseConfig& config);

  /// `job.end`: one pose per body, at rest. Bodies that the push cannot reach stay where they are;
  /// with the plain barrier, whose range is infinite, there are none. Never throws; kNonFinite also
  /// for an end state of the wrong size or with a pose that is not finite.
  [[nodiscard]] ReverseResult solve(const ReverseJob& job) const;
  /// Many jobs at once, which takes much less time than one after the other; the results are the
  /// same to the bit, whatever jobs are asked for together.
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
