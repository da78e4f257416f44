#include "core/search/random_episodes.hpp"

#include <algorithm>
#include <utility>

#include "core/search/coverage.hpp"

namespace rtg {
namespace {

constexpr int kWave = 50;               // episodes that run in lockstep
constexpr int kMaxBarren = 8;           // waves without a transition before it gives up
constexpr std::uint64_t kStream = 101;  // of random numbers, apart from those of the search

struct RandomEpisode {
  Rng rng;
  Poses state;
  std::vector<Transition> steps = {};
  bool running = true;
};

std::vector<RandomEpisode> begun(const Task& task, double jitter, std::uint64_t seed, int wave) {
  std::vector<RandomEpisode> episodes;
  for (int k = 0; k < kWave; ++k) {
    Rng rng(seed, kStream << 32 | static_cast<std::uint64_t>(wave * kWave + k));
    Poses start = jittered_start(task, jitter, rng);
    episodes.push_back({rng, std::move(start)});
  }
  return episodes;
}

/// Takes the outcome of one push over.
void advance(const Task& task, RandomEpisode& episode, const ReplayJob& push, const Poses& end) {
  const bool success = succeeded(task, end);
  episode.steps.push_back({push.start, push.action, end, success, Source::kRollOut});
  episode.state = end;
  episode.running = !success && static_cast<int>(episode.steps.size()) < task.horizon;
}

void play(const Task& task, std::vector<RandomEpisode>& episodes, const ReplayBatch& replay,
          SearchStats& stats) {
  while (true) {
    std::vector<RandomEpisode*> running;
    std::vector<ReplayJob> pushes;
    for (RandomEpisode& e : episodes) {
      if (!e.running) continue;
      running.push_back(&e);
      pushes.push_back({e.state, e.rng.below(task.push.headings)});
    }
    if (running.empty()) return;
    const std::vector<ReplayResult> results = replay(pushes);
    for (std::size_t k = 0; k < running.size(); ++k) {
      running[k]->running = stats.count(results[k]);
      if (running[k]->running) advance(task, *running[k], pushes[k], results[k].end);
    }
  }
}

/// Stores the first of them, as far as `room` allows.
void store(const RandomEpisode& episode, long room, Coverage& coverage,
           const TransitionSink& sink) {
  const auto count = std::min(static_cast<std::size_t>(room), episode.steps.size());
  const auto kept = std::span(episode.steps).first(count);
  if (kept.empty()) return;
  for (const Transition& t : kept) coverage.add(t);
  sink(kept);
}

GenerationReport report_of(const Coverage& coverage, const SearchStats& stats) {
  GenerationReport report;
  report.transitions = coverage.transitions();
  report.contact_share = coverage.contact_share();
  report.multi_body_share = coverage.multi_body_share();
  report.start_region_transitions = coverage.start_region();
  report.start_region_tree_transitions = coverage.start_region_trees();
  report.reachable_share = coverage.reachable_share();
  fill(report, stats);
  return report;
}

}  // namespace

GenerationReport random_episodes(const Task& task, const SearchConfig& config, std::uint64_t seed,
                                 const GenerationSeams& seams) {
  Coverage coverage(task);
  SearchStats stats;
  const auto cancelled = [&] { return seams.cancelled && seams.cancelled(); };
  for (int wave = 0, barren = 0; barren < kMaxBarren && !cancelled(); ++wave) {
    const long before = coverage.transitions();
    if (before >= config.transitions) break;
    std::vector<RandomEpisode> episodes = begun(task, config.rollout_jitter, seed, wave);
    play(task, episodes, seams.replay, stats);
    for (const RandomEpisode& e : episodes)
      store(e, config.transitions - coverage.transitions(), coverage, seams.store);
    barren = coverage.transitions() > before ? 0 : barren + 1;
    if (seams.progress)
      seams.progress({"random episodes", wave + 1, 0, coverage.transitions(), config.transitions,
                      coverage.contact_share(), coverage.start_region()});
  }
  return report_of(coverage, stats);
}

}  // namespace rtg
