#include "core/search/simulators.hpp"

#include <memory>
#include <utility>

#include "core/forward/make_simulator.hpp"
#include "core/reverse/naive_reverse.hpp"
#include "core/reverse/reverse_simulator.hpp"
#include "core/search/batches_on_threads.hpp"

namespace rtg::search {

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

GenerationSeams in_process_seams(SolveBatch solve, ReplayOne replay, int threads) {
  GenerationSeams seams;
  seams.solve = solve_on_threads(std::move(solve), threads);
  seams.replay = replay_on_threads(std::move(replay), threads);
  return seams;
}

}  // namespace rtg::search
