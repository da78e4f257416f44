// Beam search on Gathering: layers over breadth, depth and threads; and the replay
// of 64 pushes over threads. Those over threads are in real time.

#include <benchmark/benchmark.h>

#include <chrono>
#include <optional>

#include "core/search/beam_search.hpp"
#include "core/search/simulators.hpp"
#include "tests/bench/gathering_states.hpp"

namespace rtg::bench {
namespace {

using testing::gathering;

struct Size {
  int breadth, depth, threads;
};

double real_s() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// Adds its lifetime [s] to a sum.
class Clock {
 public:
  explicit Clock(double& sum) : sum_(sum), begin_(real_s()) {}
  ~Clock() { sum_ += real_s() - begin_; }
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

 private:
  double& sum_;
  double begin_;
};

void beam(benchmark::State& state, const Size& size) {
  const tasks::Task task = gathering();
  search::SearchConfig config;
  config.breadth = size.breadth;
  search::GenerationSeams seams =
      search::in_process_seams(task, {}, {}, search::Generator::kRrbs, size.threads,
                               replay_on_threads(search::forward_replay(task, {}), size.threads));
  double simulating = 0.0;
  seams.solve = [&simulating, solve = seams.solve](std::span<const reverse::ReverseJob> jobs) {
    const Clock clock(simulating);
    return solve(jobs);
  };
  seams.replay = [&simulating, replay = seams.replay](std::span<const search::ReplayJob> jobs) {
    const Clock clock(simulating);
    return replay(jobs);
  };
  const double begin = real_s();
  long nodes = 0, layers = 0;
  std::uint64_t seed = 0;
  for (auto _ : state) {  // trees differ in how soon they meet objects
    search::SearchStats stats;
    std::optional<search::BeamSearch> search;
    for (int layer = 0; layer < size.depth; ++layer, ++layers) {
      if (!search || search->beam().empty()) {  // a tree that cannot grow gives way to another
        search.emplace(task, config, task.start, ++seed);
        search->make_roots(seams.replay, stats);
      }
      nodes += static_cast<long>(search->beam().size());
      search->grow(seams.solve, seams.replay, stats);
    }
  }
  state.counters["search_share"] = 1.0 - simulating / (real_s() - begin);
  state.counters["layer_ms"] = 1e3 * (real_s() - begin) / static_cast<double>(layers);
  state.counters["nodes_per_layer"] = static_cast<double>(nodes) / static_cast<double>(layers);
}

void over_breadth(benchmark::State& state) {
  beam(state, {static_cast<int>(state.range(0)), 4, 1});
}
void over_depth(benchmark::State& state) { beam(state, {8, static_cast<int>(state.range(0)), 1}); }
void over_threads(benchmark::State& state) {
  beam(state, {64, 4, static_cast<int>(state.range(0))});
}

void replay(benchmark::State& state) {
  const tasks::Task task = gathering();
  const search::ReplayBatch push =
      search::replay_on_threads(search::forward_replay(task, {}), static_cast<int>(state.range(0)));
  std::vector<search::ReplayJob> jobs;
  for (const Poses& start : bench::goal_states(task))
    for (int action = 0; action < 8; ++action) jobs.push_back({start, 6 * action});
  for (auto _ : state) benchmark::DoNotOptimize(push(jobs).data());
  state.counters["scenes"] = static_cast<double>(jobs.size());
}

/// Runs a benchmark three times: on a machine that is not ours alone the median counts.
void repeated(benchmark::internal::Benchmark* one) { one->Repetitions(3)->ReportAggregatesOnly(); }

BENCHMARK(over_breadth)
    ->Name("beam/breadth")
    ->RangeMultiplier(2)
    ->Range(4, 64)
    ->Iterations(4)
    ->Apply(repeated)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(over_depth)
    ->Name("beam/depth")
    ->DenseRange(4, 24, 4)
    ->Iterations(6)
    ->Apply(repeated)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(over_threads)
    ->Name("beam/threads")
    ->RangeMultiplier(2)
    ->Range(1, 2)
    ->Iterations(2)
    ->UseRealTime()
    ->Apply(repeated)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(replay)
    ->Name("replay/threads")
    ->RangeMultiplier(2)
    ->Range(1, 2)
    ->UseRealTime()
    ->Apply(repeated)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rtg::bench
