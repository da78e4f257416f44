#include "core/search/beam_search.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "core/search/beam_selection.hpp"
#include "core/search/goal_roots.hpp"
#include "core/search/start_distance.hpp"

namespace rtg::search {

BeamSearch::BeamSearch(const tasks::Task& task, const SearchConfig& config, Poses target,
                       std::uint64_t seed, std::span<const double> paces)
    : task_(task), config_(config), metric_(task, paces), target_(std::move(target)), rng_(seed) {}

void BeamSearch::make_roots(const ReplayBatch& replay, SearchStats& stats) {
  std::vector<ReplayJob> goals;
  for (Poses& goal : goal_roots(task_, config_, metric_, target_, rng_, stats))
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
  std::unordered_set<std::uint64_t> seen = seen_;  // a copy, as not all of these steps are kept
  steps = best_of(std::move(steps), config_.plans_per_node, seen);
  const std::vector<PlanOutcome> outcomes =
      simulate_plans(steps, counted(replay, stats, Stage::kReplays), stats);
  std::vector<Transition> stored = to_store(outcomes);
  make_next_beam(std::move(steps), outcomes);
  return stored;
}

/// Solves for the predecessors of every node of the beam under every action. Returns of each solve
/// the config.predecessors_per_solve whose starts are nearest to the target.
std::vector<Predecessor> BeamSearch::reverse_layer(const SolveBatch& solve,
                                                   SearchStats& stats) const {
  std::vector<reverse::ReverseJob> jobs;
  for (const int k : beam_)
    for (int action = 0; action < action_count(task_.push); ++action)
      jobs.push_back({node(k).poses, action});
  const std::vector<reverse::ReverseResult> answers = solve(jobs);
  std::vector<Predecessor> found;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    const std::vector<Poses>& starts = answers[k].predecessors;
    stats.count(answers[k], !starts.empty() && objects_moved(starts[0], jobs[k].end) > 0);
    const int parent = beam_[k / static_cast<std::size_t>(action_count(task_.push))];
    std::vector<Predecessor> steps = proposals(task_, jobs[k], answers[k], parent, stats);
    for (Predecessor& p : steps)
      p.start_distance = start_distance(task_, metric_, p.start, target_);
    std::ranges::stable_sort(steps, {}, &Predecessor::start_distance);
    const std::size_t kept =
        std::min(steps.size(), static_cast<std::size_t>(config_.predecessors_per_solve));
    std::move(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(kept),
              std::back_inserter(found));
  }
  return found;
}

/// Returns the steps that select_beam() selects, best first: at most `times` · config.breadth.
/// Leaves out steps whose start is in a cell of `seen` and adds the cells of the others.
std::vector<Predecessor> BeamSearch::best_of(std::vector<Predecessor> steps, int times,
                                             std::unordered_set<std::uint64_t>& seen) const {
  std::vector<BeamEntry> entries;
  for (const Predecessor& p : steps)
    entries.push_back({p.start_distance, metric_.cell(p.start), metric_.layout_cell(p.start)});
  std::vector<Predecessor> best;
  const BeamLimits limits{times * config_.breadth, times * config_.nodes_per_layout};
  for (const std::size_t k : select_beam(entries, limits, seen))
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
/// Restores the starts if no plan succeeds, as where an object starts in its goal region. Adds the
/// replay_gap() of steps whose start is the solver's to stats.gaps.
std::vector<PlanOutcome> BeamSearch::simulate_plans(std::vector<Predecessor>& steps,
                                                    const ReplayBatch& replay, SearchStats& stats) {
  std::vector<Poses> own;
  std::vector<Plan> plans;
  for (Predecessor& p : steps) {
    own.push_back(std::exchange(p.start, with_drawn_start(p.start)));
    plans.push_back({p.start, plan(p)});
  }
  std::vector<PlanOutcome> outcomes = carry_out(task_, plans, replay);
  if (std::ranges::none_of(outcomes, &PlanOutcome::success)) {
    for (std::size_t k = 0; k < steps.size(); ++k) steps[k].start = plans[k].start = own[k];
    outcomes = carry_out(task_, plans, replay);
  }
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (steps[k].start == own[k] && !outcomes[k].steps.empty())
      stats.gaps.push_back(
          static_cast<float>(replay_gap(steps[k].wanted_end, outcomes[k].steps[0].next)));
  return outcomes;
}

/// Returns the first transition of each plan that succeeds; of some plans all of them.
std::vector<Transition> BeamSearch::to_store(std::span<const PlanOutcome> outcomes) {
  std::vector<Transition> stored;
  for (const auto& [success, steps] : outcomes) {
    if (!success || steps.empty()) continue;
    const bool whole = rng_.uniform(0.0, 1.0) < config_.whole_plan_share;
    stored.insert(stored.end(), steps.begin(), whole ? steps.end() : steps.begin() + 1);
  }
  return stored;
}

/// Makes the best of the steps whose plan succeeds the next beam.
void BeamSearch::make_next_beam(std::vector<Predecessor> steps,
                                std::span<const PlanOutcome> outcomes) {
  std::vector<Predecessor> good;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (!outcomes[k].success) continue;
    Predecessor& p = steps[k];
    p.depth = static_cast<int>(outcomes[k].steps.size());
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

int BeamSearch::start_depth() const {
  int least = -1;
  for (const Node& n : nodes_)
    if (n.depth > 0 && (least < 0 || n.depth < least) && in_place(metric_, n.poses, target_))
      least = n.depth;
  return least;
}

}  // namespace rtg::search
