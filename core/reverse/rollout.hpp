#pragma once

#include <optional>

#include "core/reverse/reverse_problem.hpp"

namespace rtg {

/// Servo targets of the robot, one per sub-step; entry 0 is unused.
using ServoTargets = std::vector<Vector3d>;

/// The straight path of the push, led by what the servo lags behind in free motion.
ServoTargets straight_targets(const ReverseProblem& problem);

/// Forward simulation from `start` [3·bodies]: a feasible iterate (Φ = 0, λ = λ(g)) with zero
/// multipliers. Nothing if a step fails.
std::optional<Iterate> roll_out(const ReverseProblem& problem, const VectorXd& start,
                                const ServoTargets& targets);

/// A feasible iterate that nearly ends in the final state, from mirrored forward steps: against a
/// push the contacts drag, p_{k-1} = p_k - (F(p_k) - p_k), improved by fixed-point corrections
/// towards F(p_{k-1}) = p_k, then rolled out. Nothing if a step fails.
std::optional<Iterate> warm_start(const ReverseProblem& problem);

}  // namespace rtg
