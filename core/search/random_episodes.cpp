#include "core/search/random_episodes.hpp"

#include <algorithm>
#include <utility>

#include "core/search/coverage.hpp"
#include "core/search/roll_out.hpp"

namespace rtg {
namespace {

constexpr int kWave = 50;               // episodes that run in lockstep
constexpr int kMaxBarren = 8;           // waves without a transition before it gives up
constexpr std::uint64_t kStream = 101;  // of random numbers, apart from those of the search

/// A policy that knows nothing acts at random.
std::vector<Episode> episodes(const Task& task, const SearchConfig& config, Rng rng,
                              const ReplayBatch& replay, SearchStats& stats) {
  std::vector<Poses> starts;
  for (int k = 0; k < kWave; ++k)
    starts.push_back(jittered_start(task, config.rollout_jitter, rng));
  return run_episodes(task, TreePolicy(task), {starts, 0.0, rng.word()}, replay, stats);
}

/// Stores the first of them, as far as `room` allows.
void store(const Episode& episode, long room, Coverage& coverage, const TransitionSink& sink) {
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
    Rng rng(seed, kStream << 32 | static_cast<std::uint64_t>(wave));
    for (const Episode& e : episodes(task, config, rng, seams.replay, stats))
      store(e, config.transitions - coverage.transitions(), coverage, seams.store);
    barren = coverage.transitions() > before ? 0 : barren + 1;
    if (seams.progress)
      seams.progress({"random episodes", wave + 1, 0, coverage.transitions(), config.transitions,
                      coverage.contact_share(), coverage.start_region()});
  }
  return report_of(coverage, stats);
}

}  // namespace rtg
