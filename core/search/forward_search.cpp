#include "core/search/forward_search.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "core/search/beam_selection.hpp"
#include "core/tasks/goal_distance.hpp"

namespace rtg::search {

ForwardSearch::ForwardSearch(const tasks::Task& task, const SearchConfig& config, Poses start)
    : task_(task), config_(config), metric_(task.scene), beam_{0} {
  seen_.insert(metric_.cell(start));
  nodes_.push_back({{{}, -1, std::move(start)}, 0});
}

std::vector<Transition> ForwardSearch::grow(const ReplayBatch& replay) {
  if (solved_ > 0) return {};
  std::vector<ReplayJob> pushes;
  for (const std::size_t k : beam_)
    for (int action = 0; action < action_count(task_.push); ++action)
      pushes.push_back({nodes_[k].step.next, action});
  const std::vector<ReplayResult> results = replay(pushes);
  outcomes_.clear();
  std::vector<Node> found;
  std::vector<BeamEntry> entries;
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    outcomes_.emplace(reverse::key_of(pushes[k].start, pushes[k].action), results[k]);
    if (!results[k].ok) continue;
    const Poses& end = results[k].end;
    entries.push_back({goal_distance(task_, end), metric_.cell(end)});
    const std::size_t parent = beam_[k / static_cast<std::size_t>(action_count(task_.push))];
    found.push_back({transition(task_, pushes[k], end, Source::kForward), parent});
  }
  beam_.clear();
  std::vector<Transition> steps;
  for (const std::size_t k : select_beam(entries, config_.forward_breadth, seen_)) {
    if (found[k].step.success && solved_ == 0) solved_ = nodes_.size();
    steps.push_back(found[k].step);
    beam_.push_back(nodes_.size());
    nodes_.push_back(std::move(found[k]));
  }
  return steps;
}

const ReplayResult& ForwardSearch::outcome(const ReplayJob& push) const {
  return outcomes_.at(reverse::key_of(push.start, push.action));
}

std::vector<Transition> ForwardSearch::plan() const {
  std::vector<Transition> steps;
  for (std::size_t k = solved_; k != 0; k = nodes_[k].parent) steps.push_back(nodes_[k].step);
  std::ranges::reverse(steps);
  return steps;
}

std::vector<Transition> plan_forward(const tasks::Task& task, const SearchConfig& config,
                                     const Poses& start, const ReplayBatch& replay) {
  ForwardSearch search(task, config, start);
  for (int layer = 0; layer < std::min(config.depth, task.horizon); ++layer)
    if (search.grow(replay).empty()) break;
  return search.plan();
}

void search_forward(Generation& run, int number) {
  Rng rng = run.attempt_rng(number);
  ForwardSearch search(run.task, run.config, run.draw_start(rng));
  const ReplayBatch known = [&search](std::span<const ReplayJob> pushes) {
    std::vector<ReplayResult> results;
    for (const ReplayJob& push : pushes) results.push_back(search.outcome(push));
    return results;
  };
  for (int layer = 1; layer <= run.layers(); ++layer) {
    if (run.data.full() || run.cancelled()) break;
    const std::vector<Transition> steps = search.grow(run.replay(Stage::kReplays));
    if (steps.empty()) break;
    run.data.store(steps, known);
    run.show("plan " + std::to_string(run.attempts + number + 1), layer, run.layers());
  }
}

}  // namespace rtg::search
