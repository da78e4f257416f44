#pragma once

#include <optional>
#include <span>

#include "core/search/roll_out.hpp"

namespace rtg {

/// Further than this from the entry that it follows a policy is lost [m], in its own metric.
inline constexpr double kLost = 1.0;

/// Where the data lacks something: of the first episode of the policy that starts in one of
/// `starts` and fails, the first state in which the policy is lost. Nothing if there is none.
std::optional<Poses> lost_state(const Task& task, const TreePolicy& policy,
                                std::span<const Poses> starts, const ReplayBatch& replay,
                                SearchStats& stats);

}  // namespace rtg
