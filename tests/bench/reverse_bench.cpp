// The 48 candidates of one state, one core.

#include <benchmark/benchmark.h>

#include "core/math/quantile.hpp"
#include "core/reverse/reverse_simulator.hpp"
#include "tests/bench/gathering_states.hpp"

namespace rtg::bench {
namespace {

using testing::gathering;

/// Counts what became of the candidates of all states solved.
struct Tally {
  long candidates = 0, pruned = 0, converged = 0;
  std::vector<int> iterations;  // of the converged ones

  void add(const reverse::ReverseResult& result) {
    ++candidates;
    if (result.status == reverse::SolveStatus::kPruned) ++pruned;
    if (result.status != reverse::SolveStatus::kConverged) return;
    ++converged;
    iterations.push_back(result.iterations);
  }
};

void candidates(benchmark::State& state) {
  const tasks::Task task = gathering();
  const std::vector<Poses> states = bench::goal_states(task);
  const reverse::ReverseSimulator reverse(task.scene, {}, task.push, {});
  Tally tally;
  std::size_t k = 0;
  for (auto _ : state) {
    const Poses& end = states[k++ % states.size()];
    std::vector<reverse::ReverseJob> jobs;
    for (int action = 0; action < task.push.headings; ++action) jobs.push_back({end, action});
    for (const reverse::ReverseResult& result : reverse.solve(jobs)) tally.add(result);
  }
  if (tally.converged == 0) return state.SkipWithError("no candidate converged");
  const auto solved = static_cast<double>(tally.candidates - tally.pruned);
  state.counters["pruned"] =
      static_cast<double>(tally.pruned) / static_cast<double>(tally.candidates);
  state.counters["converged"] = static_cast<double>(tally.converged) / solved;
  state.counters["iterations_median"] = quantile(tally.iterations, 0.5);
}

BENCHMARK(candidates)->Name("action48")->Unit(benchmark::kMillisecond)->Iterations(bench::kStates);

}  // namespace
}  // namespace rtg::bench
