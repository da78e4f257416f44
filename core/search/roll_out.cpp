#include "core/search/roll_out.hpp"

#include <utility>

namespace rtg {
namespace {

constexpr int kNoiseReach = 2;  // headings

int noisy(int action, int headings, double noise, Rng& rng) {
  if (rng.uniform(0.0, 1.0) >= noise) return action;
  const int step = 1 + rng.below(kNoiseReach);
  const int side = rng.below(2) == 0 ? step : headings - step % headings;
  return (action + side) % headings;
}

/// Episodes that have not ended, with all that advances them.
class Lockstep {
 public:
  Lockstep(const Task& task, const EpisodePlan& plan)
      : task_(task), noise_share_(plan.noise), episodes_(plan.starts.size()) {
    for (std::size_t k = 0; k < plan.starts.size(); ++k) {
      alive_.push_back(k);
      states_.push_back({plan.starts[k], {}});
      noise_.emplace_back(plan.seed, k);
    }
  }

  bool done() const { return alive_.empty(); }

  void step(const TreePolicy& policy, const ReplayBatch& replay, SearchStats& stats) {
    std::vector<TreePolicy::Query> queries;
    for (const std::size_t e : alive_) queries.push_back(states_[e]);
    const std::vector<TreePolicy::Choice> choices = policy.choose(queries);
    std::vector<ReplayJob> pushes;
    for (std::size_t k = 0; k < alive_.size(); ++k)
      pushes.push_back({queries[k].state, action(choices[k], noise_[alive_[k]])});
    const std::vector<ReplayResult> results = replay(pushes);
    std::vector<std::size_t> still;
    for (std::size_t k = 0; k < alive_.size(); ++k) {
      if (!stats.count(results[k])) continue;
      states_[alive_[k]].used.push_back(choices[k].entry);
      episodes_[alive_[k]].strayed.push_back(choices[k].distance);
      if (choices[k].entry >= 0) episodes_[alive_[k]].used.push_back(policy.key(choices[k].entry));
      if (record(alive_[k], pushes[k], results[k].end)) still.push_back(alive_[k]);
    }
    alive_ = std::move(still);
  }

  std::vector<Episode> take() { return std::move(episodes_); }

 private:
  int action(const TreePolicy::Choice& choice, Rng& rng) const {
    const int headings = task_.push.headings;
    return choice.entry < 0 ? rng.below(headings)
                            : noisy(choice.action, headings, noise_share_, rng);
  }

  /// Whether the episode goes on.
  bool record(std::size_t e, const ReplayJob& push, const Poses& end) {
    Episode& episode = episodes_[e];
    episode.success = succeeded(task_, end);
    episode.steps.push_back({push.start, push.action, end, episode.success, Source::kRollOut});
    states_[e].state = end;
    return !episode.success && static_cast<int>(episode.steps.size()) < task_.horizon;
  }

  const Task& task_;
  double noise_share_;
  std::vector<Episode> episodes_;
  std::vector<TreePolicy::Query> states_;
  std::vector<Rng> noise_;
  std::vector<std::size_t> alive_;
};

}  // namespace

std::vector<Episode> run_episodes(const Task& task, const TreePolicy& policy,
                                  const EpisodePlan& plan, const ReplayBatch& replay,
                                  SearchStats& stats) {
  Lockstep run(task, plan);
  while (!run.done()) run.step(policy, replay, stats);
  return run.take();
}

std::vector<Poses> jittered_starts(const Task& task, int count, double amplitude, Rng& rng) {
  std::vector<Poses> out;
  for (int k = 0; k < count; ++k) {
    const double share = rng.uniform(0.0, 1.0);
    out.push_back(jittered_start(task, share * amplitude, rng));
  }
  return out;
}

PolicyScore evaluate_policy(const Task& task, const TreePolicy& policy,
                            std::span<const Poses> starts, const ReplayBatch& replay,
                            SearchStats& stats) {
  long solved = 0, actions = 0;
  for (const Episode& e : run_episodes(task, policy, {starts}, replay, stats)) {
    solved += e.success;
    actions += static_cast<long>(e.steps.size());
  }
  const auto episodes = static_cast<double>(starts.size());
  return {static_cast<double>(solved) / episodes, static_cast<double>(actions) / episodes};
}

}  // namespace rtg
