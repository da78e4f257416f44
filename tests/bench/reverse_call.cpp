// Prints the CPU time [ms] of the solve of all actions from each of some goal states, with their
// whole solutions, one per line:
//
//   reverse_call FILE STATES
//
// FILE is a configuration; the states are those of Task.goal_state(1), (2), ... in Python. The time
// includes the release of what is found, as reverse_call.py has it.

#include <cstdio>
#include <exception>
#include <span>
#include <vector>

#include "core/reverse/reverse_simulator.hpp"
#include "core/tasks/goal_sampler.hpp"
#include "core/threads/cpu_clock.hpp"
#include "nodes/config/config.hpp"
#include "tests/bench/arguments.hpp"

namespace rtg::bench {
namespace {

void solve_all(const reverse::ReverseSimulator& simulator, const tasks::Task& task,
               const Poses& end) {
  std::vector<reverse::ReverseJob> jobs;
  for (int action = 0; action < action_count(task.push); ++action)
    jobs.push_back({end, action, true});
  static_cast<void>(simulator.solve(jobs));
}

void print_times(const config::Config& config, std::uint64_t states) {
  const tasks::Task& task = config.task;
  const reverse::ReverseSimulator simulator(task.scene, config.physics, task.push, config.reverse);
  for (std::uint64_t seed = 1; seed <= states; ++seed) {
    Rng rng(seed, 0);
    const std::optional<Poses> end = sample_goal(task, rng);
    if (!end) continue;
    const double begin = threads::thread_cpu_s();
    solve_all(simulator, task, *end);
    std::printf("%.4f\n", 1e3 * (threads::thread_cpu_s() - begin));
  }
}

}  // namespace
}  // namespace rtg::bench

int main(int count, char** words) {
  const std::span<char*> arguments(words, static_cast<std::size_t>(count));
  std::uint64_t states = 0;
  if (count != 3 ||
      !rtg::bench::read_number(arguments[2], std::uint64_t{1}, std::uint64_t{1000}, states)) {
    std::fprintf(stderr, "usage: reverse_call FILE STATES\n");
    return 2;
  }
  try {
    rtg::bench::print_times(rtg::config::load_config(arguments[1]), states);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "reverse_call: %s\n", error.what());
    return 2;
  }
  return 0;
}
