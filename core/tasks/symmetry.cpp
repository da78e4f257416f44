#include "core/tasks/symmetry.hpp"

#include <algorithm>
#include <numbers>

namespace rtg::tasks {
namespace {

bool look_the_same(const Body& a, const Body& b) {
  return a.kind == b.kind && a.shape == b.shape && a.density == b.density &&
         a.friction == b.friction;
}

/// Returns whether body `i` has a place of its own: a joint, or a term about where it started.
bool is_bound(const Task& task, std::size_t i) {
  return has_joint(task.scene, i) || std::ranges::any_of(task.goal, [&](const GoalTerm& term) {
           return std::holds_alternative<Stays>(term.condition) && concerns(term, task.scene, i);
         });
}

}  // namespace

std::vector<std::vector<std::size_t>> interchangeable(const Task& task) {
  const std::vector<Body>& bodies = task.scene.bodies;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    if (bodies[i].fixed) continue;
    const auto group = std::ranges::find_if(groups, [&](const std::vector<std::size_t>& others) {
      return look_the_same(bodies[i], bodies[others[0]]) && !is_bound(task, i) &&
             !is_bound(task, others[0]);
    });
    if (group == groups.end())
      groups.push_back({i});
    else
      group->push_back(i);
  }
  return groups;
}

double turn_period(const Scene& scene, std::size_t i) {
  return has_joint(scene, i) ? 2.0 * std::numbers::pi : scene.bodies[i].shape.symmetry();
}

}  // namespace rtg::tasks
