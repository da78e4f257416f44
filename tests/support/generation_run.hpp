#pragma once

#include <vector>

#include "core/search/generate.hpp"
#include "core/search/simulators.hpp"

namespace rtg::testing {

/// Everything that a generation with naive reverse and Box2D gave out.
struct GenerationRun {
  std::vector<search::Transition> stored;
  std::vector<search::Progress> progress;
  search::GenerationReport report;
};

/// The in-process seams over the naive reverse.
inline search::GenerationSeams naive_seams(const tasks::Task& task, int threads) {
  return search::in_process_seams(reverse_solver(task, {}, {}, search::Generator::kNaive),
                                  search::forward_replay(task, {}), threads);
}

inline GenerationRun run_naive(const tasks::Task& task, const search::SearchConfig& config,
                               std::uint64_t seed, int threads) {
  GenerationRun run;
  search::GenerationSeams seams = naive_seams(task, threads);
  seams.store = [&](std::span<const search::Transition> batch) {
    run.stored.insert(run.stored.end(), batch.begin(), batch.end());
  };
  seams.progress = [&](const search::Progress& p) { run.progress.push_back(p); };
  run.report = generate(task, config, seed, seams);
  return run;
}

}  // namespace rtg::testing
