#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/world/scene.hpp"

namespace rtg::tasks {

/// Why tries to draw a goal state failed.
struct GoalRefusals {
  std::vector<long> by_term;  // a term of the goal did not hold
  // A body met another one, or the edge of the arena (twice the body).
  std::map<std::pair<std::size_t, std::size_t>, long> no_room;
  long no_robot = 0;  // there was no place for the robot
};

/// Returns the term that caused at least half of the refusals; nothing if none did.
std::optional<std::size_t> main_term(const GoalRefusals& refusals);

/// Returns what failed most often, in words to the user: "task.goal.1 did not hold in 93% of the
/// tries".
std::string main_reason(const GoalRefusals& refusals, const Scene& scene);

}  // namespace rtg::tasks
