#pragma once

#include <vector>

#include "core/search/generate.hpp"
#include "core/search/simulators.hpp"

namespace rtg::testing {

/// Everything that a generation with Box2D gave out.
struct GenerationRun {
  std::vector<search::Transition> stored;
  std::vector<search::Progress> progress;
  search::GenerationReport report;
};

/// The in-process seams over the reverse steps of a generator.
inline search::GenerationSeams seams_of(const tasks::Task& task, search::Generator generator,
                                        int threads) {
  return search::in_process_seams(task, {}, {}, generator, threads,
                                  replay_on_threads(search::forward_replay(task, {}), threads));
}

inline search::GenerationSeams naive_seams(const tasks::Task& task, int threads) {
  return seams_of(task, search::Generator::kNaive, threads);
}

inline GenerationRun run(const tasks::Task& task, const search::SearchConfig& config,
                         std::uint64_t seed, search::GenerationSeams seams) {
  GenerationRun run;
  seams.store = [&](std::span<const search::Transition> batch) {
    run.stored.insert(run.stored.end(), batch.begin(), batch.end());
  };
  seams.progress = [&](const search::Progress& p) { run.progress.push_back(p); };
  run.report = generate(task, config, seed, seams);
  return run;
}

inline GenerationRun run_naive(const tasks::Task& task, const search::SearchConfig& config,
                               std::uint64_t seed, int threads) {
  return run(task, config, seed, naive_seams(task, threads));
}

}  // namespace rtg::testing
