#include "core/tasks/refusals.hpp"

#include <algorithm>

namespace rtg::tasks {
namespace {

/// Returns the number of all refusals.
long all_of(const Refusals& refusals) {
  long all = refusals.no_robot + refusals.solved;
  for (const long count : refusals.by_term) all += count;
  for (const auto& [bodies, count] : refusals.no_room) all += count;
  return all;
}

}  // namespace

std::optional<std::size_t> main_term(const Refusals& refusals) {
  const auto most = std::ranges::max_element(refusals.by_term);
  if (most == refusals.by_term.end() || 2 * *most < all_of(refusals)) return std::nullopt;
  return most - refusals.by_term.begin();
}

std::string main_reason(const Refusals& refusals, const Scene& scene) {
  const auto name = [&](std::size_t i) { return '\'' + scene.bodies[i].name + '\''; };
  std::vector<std::pair<long, std::string>> reasons{{refusals.no_robot, "the robot found no place"},
                                                    {refusals.solved, "the goal held"}};
  for (const auto& [bodies, count] : refusals.no_room)
    reasons.emplace_back(count, bodies.first == bodies.second
                                    ? name(bodies.first) + " was out of the arena"
                                    : name(bodies.first) + " was nearer to " + name(bodies.second) +
                                          " than the clearance");
  for (std::size_t k = 0; k < refusals.by_term.size(); ++k)
    reasons.emplace_back(refusals.by_term[k], "task.goal." + std::to_string(k) + " did not hold");
  const auto& [count, words] = *std::ranges::max_element(reasons);
  const long share = 100 * count / std::max(all_of(refusals), 1L);
  return words + " in " + std::to_string(share) + "% of the tries";
}

}  // namespace rtg::tasks
