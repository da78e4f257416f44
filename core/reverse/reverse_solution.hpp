#pragma once

#include <optional>

#include "core/reverse/candidate.hpp"

namespace rtg::reverse {

/// Returns what `solved` found for the problem of `job`, for all bodies of the scene; nothing if it
/// is not finite. `newton`: the unit of the forces in the problem, k_D/Δt² [N/(kg m)].
std::optional<ReverseSolution> solution_of(const ReverseJob& job, const Candidate& candidate,
                                           const SqpResult& solved, double newton);

}  // namespace rtg::reverse
