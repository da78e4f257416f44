#include "core/search/goal_roots.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "core/search/predecessor.hpp"
#include "core/search/state_metric.hpp"
#include "core/tasks/goal_sampler.hpp"
#include "core/tasks/symmetry.hpp"

namespace rtg::search {
namespace {

constexpr int kMaxFailures = 20;  // consecutive failed draws that end the drawing

}  // namespace

Poses with_swapped_twins(const tasks::Task& task, const StateMetric& metric, const Poses& poses,
                         const Poses& target) {
  const std::vector<std::vector<std::size_t>> groups = interchangeable(task);
  Poses best = poses;
  double least = metric.layout_distance(best, target);
  for (bool improved = true; improved;) {
    improved = false;
    for (const std::vector<std::size_t>& group : groups)
      for (std::size_t i = 0; i < group.size(); ++i)
        for (std::size_t j = i + 1; j < group.size(); ++j) {
          Poses trial = best;
          std::swap(trial[group[i]], trial[group[j]]);
          const double distance = metric.layout_distance(trial, target);
          if (distance >= least) continue;
          best = std::move(trial);
          least = distance;
          improved = true;
        }
  }
  return best;
}

std::optional<Poses> drawn_goal(const tasks::Task& task, Rng& rng, SearchStats& stats) {
  std::optional<Poses> goal = sample_goal(task, rng, &stats.goal_refusals);
  ++stats.goal_draws;
  stats.undrawn_goals += !goal;
  return goal;
}

std::vector<Poses> goal_roots(const tasks::Task& task, const SearchConfig& config,
                              const StateMetric& metric, const Poses& target, Rng& rng,
                              SearchStats& stats) {
  tasks::Task turned = task;  // the robot does not turn on the way from the target to the goal
  turned.start[0].theta = target[0].theta;
  std::unordered_set<std::uint64_t> seen;
  std::vector<std::pair<double, Poses>> drawn;
  for (int k = 0, failures = 0; k < config.breadth * config.root_draws; ++k) {
    const std::optional<Poses> goal = drawn_goal(turned, rng, stats);
    failures = goal ? 0 : failures + 1;
    if (failures == kMaxFailures) break;
    if (!goal) continue;
    Poses root = with_swapped_twins(task, metric, *goal, target);
    if (!seen.insert(metric.cell(root)).second) continue;
    drawn.emplace_back(start_distance(task, metric, root, target), std::move(root));
  }
  std::stable_sort(drawn.begin(), drawn.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const int wanted = (config.breadth + kNodesPerRoot - 1) / kNodesPerRoot;
  drawn.resize(std::min(drawn.size(), static_cast<std::size_t>(wanted)));
  std::vector<Poses> roots;
  for (auto& [score, root] : drawn) roots.push_back(std::move(root));
  return roots;
}

}  // namespace rtg::search
