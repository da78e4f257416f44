#include "core/search/roll_out.hpp"

#include <limits>
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
      : task_(task),
        noise_share_(plan.noise),
        lookahead_(plan.lookahead),
        episodes_(plan.starts.size()) {
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
    const std::vector<TreePolicy::Choice> choices =
        lookahead_ > 1 ? look_ahead(policy, queries, replay, stats) : policy.choose(queries);
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
  /// What the choices of one query lead to.
  struct Outlook {
    TreePolicy::Choice best;
    float least = std::numeric_limits<float>::infinity();
  };

  std::vector<TreePolicy::Choice> look_ahead(const TreePolicy& policy,
                                             std::span<const TreePolicy::Query> queries,
                                             const ReplayBatch& replay, SearchStats& stats) const {
    std::vector<TreePolicy::Choice> tried;
    std::vector<std::size_t> of;  // query of each
    std::vector<ReplayJob> pushes;
    for (std::size_t q = 0; q < queries.size(); ++q)
      for (const TreePolicy::Choice& choice : policy.alternatives(queries[q], lookahead_)) {
        tried.push_back(choice);
        of.push_back(q);
        pushes.push_back({queries[q].state, choice.action});
      }
    const std::vector<ReplayResult> results = replay(pushes);
    std::vector<Outlook> outlooks(queries.size());
    for (std::size_t k = 0; k < tried.size(); ++k) {
      if (!stats.count(results[k])) continue;
      Outlook& outlook = outlooks[of[k]];
      const float score = score_after(policy, queries[of[k]], tried[k].entry, results[k].end);
      if (score < outlook.least) outlook = {tried[k], score};
    }
    std::vector<TreePolicy::Choice> out;
    for (const Outlook& outlook : outlooks) out.push_back(outlook.best);
    return out;
  }

  float score_after(const TreePolicy& policy, TreePolicy::Query query, int entry,
                    const Poses& end) const {
    if (succeeded(task_, end)) return 0.0F;
    query.state = end;
    query.used.push_back(entry);
    return policy.choose({&query, 1}).front().score;
  }

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
  int lookahead_;
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
