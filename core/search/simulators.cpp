#include "core/search/simulators.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/forward/make_simulator.hpp"
#include "core/math/lanes.hpp"
#include "core/reverse/naive_reverse.hpp"
#include "core/reverse/reverse_simulator.hpp"
#include "core/threads/cpu_clock.hpp"
#include "core/threads/parallel_for.hpp"
#include "core/world/pace.hpp"

namespace rtg::search {
namespace {

constexpr std::size_t kLanes = static_cast<std::size_t>(kWidth<Lanes>);

/// Splits `jobs` jobs into slices and returns the end index of each slice. Idle threads take the
/// next slice. Each slice is 1 / (2 · threads) of the remaining jobs (guided self-scheduling
/// [Polychronopoulos & Kuck 1987]). All threads thus finish at about the same time. A slice has at
/// least enough jobs to fill the SIMD lanes.
std::vector<std::size_t> slice_ends(std::size_t jobs, int threads) {
  if (threads <= 1) return {jobs};
  const auto workers = static_cast<std::size_t>(threads);
  const std::size_t least =
      std::clamp(jobs / workers / kLanes, std::size_t{1}, std::size_t{4}) * kLanes;
  std::vector<std::size_t> ends;
  for (std::size_t begun = 0; begun < jobs; begun = ends.back()) {
    const std::size_t left = jobs - begun, size = std::max(least, left / (2 * workers));
    ends.push_back(left < size + kLanes ? jobs : begun + size);
  }
  return ends;
}

}  // namespace

SolveBatch reverse_solver(const tasks::Task& task, const PhysicsConfig& physics,
                          const reverse::ReverseConfig& reverse, Generator generator) {
  if (generator == Generator::kNaive)
    return [naive = std::make_shared<const reverse::NaiveReverse>(task.scene, task.push)](
               std::span<const reverse::ReverseJob> jobs) {
      std::vector<reverse::ReverseResult> results;
      for (const reverse::ReverseJob& job : jobs) results.push_back(naive->solve(job));
      return results;
    };
  return [rrbs = std::make_shared<const reverse::ReverseSimulator>(
              task.scene, physics, task.push, reverse)](std::span<const reverse::ReverseJob> jobs) {
    return rrbs->solve(jobs);
  };
}

ReplayOne forward_replay(const tasks::Task& task, const PhysicsConfig& physics,
                         const forward::ForwardConfig& forward) {
  return [simulator = std::shared_ptr(make_simulator(forward, task.scene, task.push, physics))](
             const ReplayJob& job) {
    forward::PushOutcome outcome = job.action == kSettle ? simulator->settle(job.start)
                                                         : simulator->push(job.start, job.action);
    return ReplayResult{std::move(outcome.end), outcome.ok, 0.0};
  };
}

SolveBatch solve_on_threads(SolveBatch solve, int threads) {
  return [solve = std::move(solve), threads](std::span<const reverse::ReverseJob> jobs) {
    std::vector<reverse::ReverseResult> results(jobs.size());
    const std::vector<std::size_t> ends = slice_ends(jobs.size(), threads);
    threads::parallel_for(ends.size(), threads, [&](std::size_t slice) {
      const std::size_t first = slice == 0 ? 0 : ends[slice - 1], count = ends[slice] - first;
      if (count == 0) return;
      const double begin = threads::thread_cpu_s();
      std::vector<reverse::ReverseResult> some = solve(jobs.subspan(first, count));
      const double share = (threads::thread_cpu_s() - begin) / static_cast<double>(count);
      for (std::size_t k = 0; k < count; ++k) {
        results[first + k] = std::move(some[k]);
        results[first + k].cpu_s = share;
      }
    });
    return results;
  };
}

ReplayBatch replay_on_threads(ReplayOne replay, int threads) {
  return [replay = std::move(replay), threads](std::span<const ReplayJob> jobs) {
    std::vector<ReplayResult> results(jobs.size());
    threads::parallel_for(jobs.size(), threads, [&](std::size_t k) {
      const double begin = threads::thread_cpu_s();
      results[k] = replay(jobs[k]);
      results[k].cpu_s = threads::thread_cpu_s() - begin;
    });
    return results;
  };
}

GenerationSeams in_process_seams(const tasks::Task& task, const PhysicsConfig& physics,
                                 const reverse::ReverseConfig& reverse, Generator generator,
                                 int threads, ReplayBatch replay) {
  GenerationSeams seams;
  seams.solve = solve_on_threads(reverse_solver(task, physics, reverse, generator), threads);
  seams.replay = std::move(replay);
  seams.paces = paces(task.scene, physics);
  return seams;
}

}  // namespace rtg::search
