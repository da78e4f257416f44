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
  BeamSearch* const alone = this;
  return grow_together({&alone, 1}, solve, replay, stats);
}

std::vector<Transition> BeamSearch::grow_together(std::span<BeamSearch* const> trees,
                                                  const SolveBatch& solve,
                                                  const ReplayBatch& replay, SearchStats& stats) {
  std::vector<reverse::ReverseJob> jobs;
  std::vector<std::size_t> begins{0};  // of the jobs of each tree
  for (const BeamSearch* tree : trees) {
    std::ranges::move(tree->reverse_jobs(), std::back_inserter(jobs));
    begins.push_back(jobs.size());
  }
  const std::vector<reverse::ReverseResult> answers = timed(solve, stats, Stage::kSolves)(jobs);
  std::vector<Layer> layers;
  for (std::size_t k = 0; k < trees.size(); ++k) {
    const std::size_t first = begins[k], count = begins[k + 1] - first;
    layers.push_back(trees[k]->with_plans(trees[k]->nearest_steps(
        std::span(jobs).subspan(first, count), std::span(answers).subspan(first, count), stats)));
  }
  if (!trees.empty()) simulate(layers, trees[0]->task_, counted(replay, stats, Stage::kReplays));
  std::vector<Transition> stored;
  for (std::size_t k = 0; k < trees.size(); ++k) {
    count_gaps(layers[k], stats);
    std::ranges::move(trees[k]->to_store(layers[k].outcomes), std::back_inserter(stored));
    trees[k]->make_next_beam(std::move(layers[k]));
  }
  return stored;
}

/// Returns the reverse jobs of every node of the beam under every action.
std::vector<reverse::ReverseJob> BeamSearch::reverse_jobs() const {
  std::vector<reverse::ReverseJob> jobs;
  for (const int k : beam_)
    for (int action = 0; action < action_count(task_.push); ++action)
      jobs.push_back({node(k).poses, action});
  return jobs;
}

/// Returns of each solve the config.predecessors_per_solve whose starts are nearest to the target.
/// `jobs`: reverse_jobs().
std::vector<Predecessor> BeamSearch::nearest_steps(std::span<const reverse::ReverseJob> jobs,
                                                   std::span<const reverse::ReverseResult> answers,
                                                   SearchStats& stats) const {
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
  for (const Predecessor& p : steps) entries.push_back({p.start_distance, metric_.cell(p.start)});
  std::vector<Predecessor> best;
  for (const std::size_t k : select_beam(entries, times * config_.breadth, seen))
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

/// Returns the plans that begin with the best of `steps`, whose starts are replaced by
/// with_drawn_start().
BeamSearch::Layer BeamSearch::with_plans(std::vector<Predecessor> steps) {
  std::unordered_set<std::uint64_t> seen = seen_;  // a copy, as not all of these steps are kept
  Layer layer{.steps = best_of(std::move(steps), config_.plans_per_node, seen)};
  for (Predecessor& p : layer.steps) {
    layer.found.push_back(std::exchange(p.start, with_drawn_start(p.start)));
    layer.plans.push_back({p.start, plan(p)});
  }
  return layer;
}

/// Simulates the plans of all layers. Where no plan of a layer succeeds, as where an object starts
/// in its goal region, simulates them again from the starts that the solver found.
void BeamSearch::simulate(std::vector<Layer>& layers, const tasks::Task& task,
                          const ReplayBatch& replay) {
  const auto run = [&](const std::vector<Layer*>& some) {
    std::vector<Plan> plans;
    for (const Layer* layer : some) std::ranges::copy(layer->plans, std::back_inserter(plans));
    std::vector<PlanOutcome> outcomes = carry_out(task, plans, replay);
    auto next = std::make_move_iterator(outcomes.begin());
    for (Layer* layer : some) {
      const auto end = next + static_cast<std::ptrdiff_t>(layer->plans.size());
      layer->outcomes.assign(next, end);
      next = end;
    }
  };
  std::vector<Layer*> all, failed;
  for (Layer& layer : layers) all.push_back(&layer);
  run(all);
  for (Layer& layer : layers) {
    if (std::ranges::any_of(layer.outcomes, &PlanOutcome::success)) continue;
    for (std::size_t k = 0; k < layer.steps.size(); ++k)
      layer.steps[k].start = layer.plans[k].start = layer.found[k];
    failed.push_back(&layer);
  }
  run(failed);
}

/// Adds the replay_gap() of steps whose start is the solver's to stats.gaps.
void BeamSearch::count_gaps(const Layer& layer, SearchStats& stats) {
  const auto& [steps, found, plans, outcomes] = layer;
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (steps[k].start == found[k] && !outcomes[k].steps.empty())
      stats.gaps.push_back(
          static_cast<float>(replay_gap(steps[k].wanted_end, outcomes[k].steps[0].next)));
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
void BeamSearch::make_next_beam(Layer layer) {
  std::vector<Predecessor> good;
  for (std::size_t k = 0; k < layer.steps.size(); ++k) {
    if (!layer.outcomes[k].success) continue;
    Predecessor& p = layer.steps[k];
    p.depth = static_cast<int>(layer.outcomes[k].steps.size());
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
