// Reverses pushes that the forward simulator has made, on one core, and prints how many it finds:
//
//   true_pushes CONFIG.yaml... [--count N] [--compare]
//               [--preset default|paper] [--set NAME VALUE]...
//
// For each task it draws N (200) pushes of Box2D that move an object by half a metre or more. From
// the end of each it solves for the push that led there. A start *drags* if an object moves from it
// by 0.05 m or more, and replays if Box2D leads from it back to the end, to 0.1 m in the mean over
// the bodies. Columns: pushes that have a start that drags; that also replays (found); whose start
// of the whole push does (whole); how far this start moves an object, as a share of the true push
// (way, median); iterations; CPU time of all per push found. --set takes keys of the sections
// reverse and physics. --compare solves the same pushes with the preset paper as well and compares
// the CPU times per push found. There are gates for each task, but none for the preset paper alone.
// Exit status 1 if a gate fails, 2 for bad input.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/forward/box2d_simulator.hpp"
#include "core/math/quantile.hpp"
#include "core/reverse/reverse_simulator.hpp"
#include "core/search/predecessor.hpp"
#include "core/threads/cpu_clock.hpp"
#include "nodes/config/config.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/gate.hpp"
#include "tests/bench/true_push.hpp"

namespace rtg::bench {
namespace {

constexpr double kDragged = 0.05;  // least displacement in a solution that drags [m]
constexpr double kMiss = 0.1;      // largest replay gap of a solution that counts as found [m]
constexpr std::size_t kTogether = 48;
constexpr int kFewest = 5;  // pushes found; a time per push of fewer says nothing
constexpr double kFoundGate = 0.95;
constexpr double kPaperGate = 100.0;

struct Options {
  SolverOptions solver;
  std::size_t count = 200;
  bool compare = false;
  std::vector<std::string> files;
};

struct Tally {
  std::array<int, reverse::kSolveStatusCount> ends{};
  int drags = 0, found = 0, whole = 0;
  std::vector<double> ways;
  std::vector<int> iterations;  // of the converged ones
  double cpu_s = 0.0;
};

/// Counts the result of one push.
void count(const TruePush& push, const reverse::ReverseResult& result,
           const forward::Simulator& box2d, Tally& tally) {
  ++tally.ends[static_cast<std::size_t>(result.status)];
  if (result.predecessors.empty()) return;
  tally.iterations.push_back(result.iterations);
  const Poses& end = push.job.end;
  const auto drags = [&](const Poses& start) {
    return largest_displacement(start, end) >= kDragged;
  };
  const auto replays = [&](const Poses& start) {
    if (!drags(start)) return false;
    const forward::PushOutcome replayed = box2d.push(start, push.job.action);
    return replayed.ok && search::replay_gap(end, replayed.end) <= kMiss;
  };
  tally.drags += std::ranges::any_of(result.predecessors, drags);
  tally.found += std::ranges::any_of(result.predecessors, replays);
  tally.whole += replays(result.predecessors[0]);
  tally.ways.push_back(largest_displacement(result.predecessors[0], end) / push.displacement);
}

Tally solve(const tasks::Task& task, std::span<const TruePush> pushes,
            const forward::Simulator& box2d, const SolverOptions& solver) {
  const reverse::ReverseSimulator simulator(task.scene, solver.physics, task.push, solver.reverse);
  Tally tally;
  for (std::size_t first = 0; first < pushes.size(); first += kTogether) {
    const auto some = pushes.subspan(first, std::min(kTogether, pushes.size() - first));
    std::vector<reverse::ReverseJob> jobs;
    for (const TruePush& push : some) jobs.push_back(push.job);
    const double begin = threads::thread_cpu_s();
    const std::vector<reverse::ReverseResult> results = simulator.solve(jobs);
    tally.cpu_s += threads::thread_cpu_s() - begin;
    for (std::size_t k = 0; k < jobs.size(); ++k) count(some[k], results[k], box2d, tally);
  }
  return tally;
}

/// CPU time per push found [s].
double per_found(const Tally& tally) {
  return tally.found > 0 ? tally.cpu_s / tally.found : INFINITY;
}

void print(const std::string& name, const Tally& tally, std::size_t count) {
  std::printf("%-20s %6zu %6d %6d %6d %6.2f %7.0f %7.0f %12.3g ", name.c_str(), count, tally.drags,
              tally.found, tally.whole, quantile(tally.ways, 0.5), quantile(tally.iterations, 0.5),
              quantile(tally.iterations, 0.9), 1e3 * per_found(tally));
  for (int status = 0; status < reverse::kSolveStatusCount; ++status)
    if (const int number = tally.ends[static_cast<std::size_t>(status)])
      std::printf(" %s %d", reverse::name(static_cast<reverse::SolveStatus>(status)).data(),
                  number);
  std::printf("\n");
  std::fflush(stdout);
}

/// The results of one task.
struct TaskTally {
  std::string task;
  Tally ours;
  std::optional<Tally> paper;  // with --compare
};

/// Returns how many times our CPU time per push found the preset paper takes. If it found fewer
/// than kFewest pushes, says so and returns NaN, with which no gate holds.
double paper_by_default(const TaskTally& result) {
  if (result.paper->found >= kFewest) return per_found(*result.paper) / per_found(result.ours);
  std::printf("%s, paper: found %d, fewer than %d, so that a ratio of times says nothing\n",
              result.task.c_str(), result.paper->found, kFewest);
  return NAN;
}

/// Prints the gates of one task. Returns whether they hold.
bool hold(const TaskTally& result, const Options& options) {
  const std::string name = "true_pushes." + result.task;
  bool passed = true;
  if (options.solver.reverse.preset == reverse::ReversePreset::kDefault) {
    const double share = result.ours.found / static_cast<double>(options.count);
    passed = gate(name + ".found", share, Bound::kAtLeast, kFoundGate);
  }
  if (result.paper)
    passed &=
        gate(name + ".paper_by_default", paper_by_default(result), Bound::kAtLeast, kPaperGate);
  return passed;
}

/// Applies the flag at the beginning of `words`. Returns how many words it took: 0 if it is wrong.
std::size_t apply(std::span<char* const> words, Options& options) {
  const std::string_view word = words[0];
  if (!word.starts_with("--")) {
    options.files.emplace_back(word);
    return 1;
  }
  if (word == "--compare") {
    options.compare = true;
    return 1;
  }
  if (word == "--count")
    return words.size() >= 2 &&
                   read_number(words[1], std::size_t{1}, std::size_t{100000}, options.count)
               ? 2
               : 0;
  return apply(words, options.solver);
}

std::optional<Options> parsed(std::span<char* const> words) {
  const auto options = read_options<Options>("true_pushes", words);
  if (!options || !options->files.empty()) return options;
  std::fprintf(stderr, "true_pushes: name the files of tasks, config/gathering.yaml\n");
  return std::nullopt;
}

int run(const Options& options) {
  std::printf("%-20s %6s %6s %6s %6s %6s %7s %7s %12s\n", "", "pushes", "drag", "found", "whole",
              "way", "median", "p90", "CPU/found ms");
  const SolverOptions paper{reverse_preset(reverse::ReversePreset::kPaper), options.solver.physics};
  std::vector<TaskTally> results;
  for (const std::string& file : options.files) {
    const tasks::Task task = config::load_config(file).task;
    const forward::Box2dSimulator box2d(task.scene, task.push, options.solver.physics);
    const std::vector<TruePush> pushes = draw_pushes(task, box2d, options.count);
    TaskTally result{task.name, solve(task, pushes, box2d, options.solver), std::nullopt};
    print(task.name, result.ours, options.count);
    if (options.compare) {
      result.paper = solve(task, pushes, box2d, paper);
      print(task.name + ", paper", *result.paper, options.count);
    }
    results.push_back(std::move(result));
  }
  std::printf("\n");
  bool passed = true;
  for (const TaskTally& result : results) passed &= hold(result, options);
  return passed ? 0 : 1;
}

}  // namespace
}  // namespace rtg::bench

int main(int argc, char** argv) {
  const auto options = rtg::bench::parsed({argv + 1, argv + argc});
  if (!options) return 2;
  try {
    return rtg::bench::run(*options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "true_pushes: %s\n", error.what());
    return 2;
  }
}
