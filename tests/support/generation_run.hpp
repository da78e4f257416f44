#pragma once

#include <vector>

#include "core/search/generate.hpp"
#include "core/search/simulators.hpp"

namespace rtg::testing {

/// Everything that a generation with naive reverse and Box2D gave out.
struct GenerationRun {
  std::vector<Transition> stored;
  std::vector<Progress> progress;
  GenerationReport report;
};

/// The in-process seams over the naive reverse.
inline GenerationSeams naive_seams(const Task& task, int threads) {
  return in_process_seams(reverse_solver(task, {}, {}, Generator::kNaive), forward_replay(task, {}),
                          threads);
}

inline GenerationRun run_naive(const Task& task, const SearchConfig& config, std::uint64_t seed,
                               int threads) {
  GenerationRun run;
  GenerationSeams seams = naive_seams(task, threads);
  seams.store = [&](std::span<const Transition> batch) {
    run.stored.insert(run.stored.end(), batch.begin(), batch.end());
  };
  seams.progress = [&](const Progress& p) { run.progress.push_back(p); };
  run.report = generate(task, config, seed, seams);
  return run;
}

}  // namespace rtg::testing
