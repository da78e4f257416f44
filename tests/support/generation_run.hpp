#pragma once

#include <utility>
#include <vector>

#include "core/forward/box2d_simulator.hpp"
#include "core/search/generate.hpp"
#include "core/search/naive_reverse.hpp"
#include "core/search/thread_pool.hpp"

namespace rtg::testing {

/// Everything that a generation with naive reverse and Box2D gave out.
struct GenerationRun {
  std::vector<Transition> stored;
  std::vector<Progress> progress;
  GenerationReport report;
};

/// The in-process seams over a simulator and the naive reverse, both of which must outlive them.
inline GenerationSeams naive_seams(const Box2dSimulator& simulator, const NaiveReverse& naive,
                                   int threads) {
  GenerationSeams seams;
  seams.solve = solve_on_threads([&](const ReverseJob& job) { return naive.solve(job); }, threads);
  seams.replay = replay_on_threads(
      [&](const ReplayJob& job) {
        PushOutcome outcome = simulator.push(job.start, job.action);
        return ReplayResult{std::move(outcome.end), outcome.ok, 0.0};
      },
      threads);
  seams.settle = [&](const Poses& poses) { return simulator.settle(poses).end; };
  return seams;
}

inline GenerationRun run_naive(const Task& task, const SearchConfig& config, std::uint64_t seed,
                               int threads) {
  const Box2dSimulator simulator(task.scene, task.push, {});
  const NaiveReverse naive(task.scene, task.push);
  GenerationRun run;
  GenerationSeams seams = naive_seams(simulator, naive, threads);
  seams.store = [&](std::span<const Transition> batch) {
    run.stored.insert(run.stored.end(), batch.begin(), batch.end());
  };
  seams.progress = [&](const Progress& p) { run.progress.push_back(p); };
  run.report = generate(task, config, seed, seams);
  return run;
}

}  // namespace rtg::testing
