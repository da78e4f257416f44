#pragma once

#include <cstdint>
#include <string_view>

namespace rtg::reverse {

/// Outcome of a reverse solve.
enum class SolveStatus : std::int8_t {
  kConverged,         // constraints and stationarity below their tolerances
  kAcceptable,        // as kConverged, but for stationarity
  kPruned,            // the action cannot have led to the final state; nothing was solved
  kInfeasible,        // the solution misses the final state, or bodies overlap
  kIterationLimit,    // max_iterations reached
  kLineSearchFailed,  // no acceptable step, even with the largest regularisation
  kSingular,          // no descent step, or a KKT system that could not be factorised
  kNonFinite,         // NaN or infinity occurred
};
inline constexpr int kSolveStatusCount = 8;

constexpr std::string_view name(SolveStatus s) {
  constexpr std::string_view names[] = {"converged",  "acceptable",      "pruned",
                                        "infeasible", "iteration_limit", "line_search_failed",
                                        "singular",   "non_finite"};
  return names[static_cast<int>(s)];
}

/// Returns whether a reverse solve with outcome `s` has predecessors.
constexpr bool has_predecessors(SolveStatus s) {
  return s == SolveStatus::kConverged || s == SolveStatus::kAcceptable;
}

}  // namespace rtg::reverse
