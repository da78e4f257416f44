#include "core/search/walks.hpp"

#include <utility>
#include <vector>

#include "core/search/goal_roots.hpp"
#include "core/tasks/contact_heading.hpp"

namespace rtg::search {
namespace {

constexpr int kWave = 50;         // walks that run side by side
constexpr double kSeeking = 0.5;  // share of the pushes that seek contact, the others are uniform
// Pushes of a walk from a goal state: 55 of 49,000 of Gathering succeed, with 60 pushes 8.
constexpr int kPushesFromGoal = 6;

int heading(const Generation& run, const Poses& state, Rng& rng) {
  const bool seeks = rng.uniform(0.0, 1.0) < kSeeking;
  return seeks ? contact_heading(run.task, state, rng) : rng.below(action_count(run.task.push));
}

}  // namespace

void walk(Generation& run, int number) {
  Rng rng = run.attempt_rng(number);
  const bool from_goals = run.config.generator == Generator::kScatter;
  const int length = from_goals ? kPushesFromGoal : run.task.horizon;
  std::vector<Poses> states;
  for (int k = 0; k < kWave; ++k)
    if (auto state = from_goals ? drawn_goal(run.task, rng, run.stats) : run.draw_start(rng))
      states.push_back(*std::move(state));
  for (int step = 0; step < length && !states.empty() && !run.data.full(); ++step) {
    std::vector<ReplayJob> pushes;
    for (const Poses& state : states) pushes.push_back({state, heading(run, state, rng)});
    const std::vector<ReplayResult> results = run.replay(Stage::kReplays)(pushes);
    std::vector<Transition> steps;
    states.clear();
    for (std::size_t k = 0; k < pushes.size(); ++k) {
      if (!results[k].ok) continue;
      if (!succeeded(run.task, pushes[k].start))
        steps.push_back(transition(run.task, pushes[k], results[k].end, Source::kWalk));
      states.push_back(results[k].end);
    }
    run.data.store(steps, run.replay(Stage::kBranches));
  }
  run.show("random walks", run.attempts + number + 1, 0);
}

}  // namespace rtg::search
