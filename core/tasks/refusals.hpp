#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/world/scene.hpp"

namespace rtg::tasks {

/// Why draws of goal states or of start states were refused.
struct Refusals {
  std::vector<long> by_term;  // goal states: a term of the goal did not hold
  // A body was nearer to another one than the clearance, or out of the arena (twice the body).
  std::map<std::pair<std::size_t, std::size_t>, long> no_room;
  long no_robot = 0;  // goal states: there was no place for the robot
  long solved = 0;    // start states: the goal held
};

/// Returns the term that caused at least half of the refusals; nothing if none did.
std::optional<std::size_t> main_term(const Refusals& refusals);

/// Returns what failed most often, in words to the user: "task.goal.1 did not hold in 93% of the
/// tries".
std::string main_reason(const Refusals& refusals, const Scene& scene);

}  // namespace rtg::tasks
