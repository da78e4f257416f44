#include "core/search/beam_search.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/search/beam_selection.hpp"
#include "core/search/goal_roots.hpp"
#include "core/search/start_distance.hpp"

namespace rtg::search {

BeamSearch::BeamSearch(const tasks::Task& task, const SearchConfig& config, Poses target,
                       std::uint64_t seed)
    : task_(task), config_(config), metric_(task.scene), target_(std::move(target)), rng_(seed) {}

void BeamSearch::make_roots(const ReplayBatch& replay, SearchStats& stats) {
  std::vector<ReplayJob> goals;
  for (Poses& goal : goal_roots(task_, config_, target_, rng_, stats))
    goals.push_back({std::move(goal), kSettle});
  for (const ReplayResult& settled : replay(goals)) {
    if (!settled.ok) continue;
    Poses rest = to_single(settled.end);
    if (!legal_state(task_, rest) || !succeeded(task_, rest)) {
      ++stats.unsettled_goals;
      continue;
    }
    if (!seen_.insert(metric_.cell(rest)).second) continue;
    beam_.push_back(static_cast<int>(nodes_.size()));
    nodes_.push_back({.poses = std::move(rest)});
  }
}

std::vector<Transition> BeamSearch::grow(const SolveBatch& solve, const ReplayBatch& replay,
                                         SearchStats& stats) {
  std::vector<Predecessor> steps = reverse_layer(timed(solve, stats, Stage::kSolves), stats);
  steps = best_to_replay(std::move(steps));
  steps = replay_predecessors(std::move(steps), config_.gap_tolerance,
                              counted(replay, stats, Stage::kReplays), stats);
  std::unordered_set<std::uint64_t> seen = seen_;  // a copy, as not all of these steps are kept
  steps = best_of(std::move(steps), config_.plans_per_node, seen);
  const std::vector<PlanOutcome> outcomes =
      simulate_plans(steps, counted(replay, stats, Stage::kPlans));
  std::vector<Transition> stored = to_store(outcomes);
  make_next_beam(std::move(steps), outcomes);
  return stored;
}

/// Solves for the predecessors of every node of the beam under every action.
std::vector<Predecessor> BeamSearch::reverse_layer(const SolveBatch& solve,
                                                   SearchStats& stats) const {
  std::vector<reverse::ReverseJob> jobs;
  for (const int k : beam_)
    for (int action = 0; action < task_.push.headings; ++action)
      jobs.push_back({node(k).poses, action});
  const std::vector<reverse::ReverseResult> answers = solve(jobs);
  std::vector<Predecessor> found;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    const std::vector<Poses>& starts = answers[k].predecessors;
    stats.count(answers[k], !starts.empty() && objects_moved(starts[0], jobs[k].end) > 0);
    const int parent = beam_[k / static_cast<std::size_t>(task_.push.headings)];
    for (Predecessor& p : proposals(task_, jobs[k], answers[k], parent, stats))
      found.push_back(std::move(p));
  }
  return found;
}

/// Returns the steps to replay, those whose start is nearest to the target:
///
///  - of the steps that move no object, the best config.free_moves per node;
///  - of the others, the best config.predecessors_per_solve per node and action.
std::vector<Predecessor> BeamSearch::best_to_replay(std::vector<Predecessor> all) const {
  for (Predecessor& p : all) p.start_distance = start_distance(task_, metric_, p.start, target_);
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return all[k].start_distance; });
  std::unordered_map<int, int> idle, pushing;  // counts per node and per solve
  std::erase_if(order, [&](std::size_t k) {
    const Predecessor& p = all[k];
    if (p.moved == 0) return ++idle[p.parent] > config_.free_moves;
    const int solve = p.parent * task_.push.headings + p.action;
    return ++pushing[solve] > config_.predecessors_per_solve;
  });
  std::ranges::sort(order);
  std::vector<Predecessor> out;
  for (const std::size_t k : order) out.push_back(std::move(all[k]));
  return out;
}

/// Returns the steps that select_beam() selects, best first: at most `times` · config.breadth.
/// Leaves out steps whose start is in a cell of `seen` and adds the cells of the others.
std::vector<Predecessor> BeamSearch::best_of(std::vector<Predecessor> steps, int times,
                                             std::unordered_set<std::uint64_t>& seen) const {
  std::vector<BeamEntry> entries;
  for (const Predecessor& p : steps)
    entries.push_back({p.start_distance, metric_.cell(p.start), metric_.layout_cell(p.start)});
  std::vector<Predecessor> best;
  for (const std::size_t k : select_beam(entries, config_, seen, times))
    best.push_back(std::move(steps[k]));
  return best;
}

/// Returns the actions that lead from the start of a step to success.
std::vector<int> BeamSearch::plan(const Predecessor& step) const {
  std::vector<int> actions{step.action};
  for (int k = step.parent; node(k).action >= 0; k = node(k).parent)
    actions.push_back(node(k).action);
  return actions;
}

/// Returns snapped_to_start() of `poses` for a random start; `poses` if that is not legal. An
/// object in place stays in place, so start_distance() stays as it is.
Poses BeamSearch::with_drawn_start(const Poses& poses) {
  constexpr double kAround = 0.25;  // largest random displacement of an object [m]
  const double around = std::min(task_.start_jitter, kAround);
  const std::optional<Poses> start = jittered(task_, target_, around, rng_);
  const Poses at_start = snapped_to_start(task_, metric_, poses, target_, start.value_or(target_));
  return legal_state(task_, at_start) ? at_start : poses;
}

/// Replaces the start of each step by with_drawn_start() and simulates the plans from there.
/// Restores the starts if no plan succeeds, as where an object starts in its goal region.
std::vector<PlanOutcome> BeamSearch::simulate_plans(std::vector<Predecessor>& steps,
                                                    const ReplayBatch& replay) {
  std::vector<Poses> own;
  std::vector<Plan> plans;
  for (Predecessor& p : steps) {
    own.push_back(std::exchange(p.start, with_drawn_start(p.start)));
    plans.push_back({p.start, plan(p)});
  }
  std::vector<PlanOutcome> outcomes = carry_out(task_, plans, replay);
  if (std::ranges::any_of(outcomes, [](const auto& o) { return o.has_value(); })) return outcomes;
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k].start = plans[k].start = own[k];
  return carry_out(task_, plans, replay);
}

/// Returns the first transition of each plan that succeeds; of some plans all of them.
std::vector<Transition> BeamSearch::to_store(std::span<const PlanOutcome> outcomes) {
  std::vector<Transition> stored;
  for (const PlanOutcome& outcome : outcomes) {
    if (!outcome || outcome->empty()) continue;
    const bool whole = rng_.uniform(0.0, 1.0) < config_.whole_plan_share;
    stored.insert(stored.end(), outcome->begin(), whole ? outcome->end() : outcome->begin() + 1);
  }
  return stored;
}

/// Makes the best of the steps whose plan succeeds the next beam.
void BeamSearch::make_next_beam(std::vector<Predecessor> steps,
                                std::span<const PlanOutcome> outcomes) {
  std::vector<Predecessor> good;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (!outcomes[k]) continue;
    Predecessor& p = steps[k];
    p.depth = static_cast<int>(outcomes[k]->size());
    good.push_back(std::move(p));
  }
  beam_.clear();
  for (Predecessor& p : best_of(std::move(good), 1, seen_)) {
    beam_.push_back(static_cast<int>(nodes_.size()));
    nodes_.push_back({std::move(p.start), p.depth == 0 ? -1 : p.action, p.parent, p.depth});
  }
}

double BeamSearch::min_start_distance() const {
  double best = std::numeric_limits<double>::infinity();
  for (const int k : beam_)
    best = std::min(best, start_distance(task_, metric_, node(k).poses, target_));
  return best;
}

}  // namespace rtg::search
