#pragma once

#include <optional>

#include "core/reverse/linearisation.hpp"

namespace rtg {

/// x + α d, if it is a legal iterate: every gap stays open and, below a tenth of the barrier's
/// range, keeps a tenth of itself, no two bodies overlap by the separating-axis test, no pose moves
/// by more than 1 m or 0.5 rad; nothing otherwise.
std::optional<Iterate> trial_point(const ReverseProblem& problem, const Iterate& x,
                                   const Direction& d, double alpha);

}  // namespace rtg
