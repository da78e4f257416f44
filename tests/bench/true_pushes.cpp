// Reverses pushes that the forward simulator has made, on one core, and prints how many it finds:
//
//   true_pushes CONFIG.yaml... [--count N] [--preset default|paper] [--set NAME VALUE]...
//
// For each task it draws N (200) pushes of Box2D that move an object by half a metre or more. From
// the end of each it solves for the push that led there. A start *drags* if an object moves from it
// by 0.05 m or more, and replays if Box2D leads from it back to the end, to 0.1 m in the mean over
// the bodies. Columns: pushes that have a start that drags; that also replays (found); whose start
// of the whole push does (whole); how far this start moves an object, as a share of the true push
// (way, median); iterations; CPU time of all per push found. --set takes keys of the sections
// reverse and physics. Exit status 1 if a gate of the preset default fails, 2 for bad input.

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/forward/box2d_simulator.hpp"
#include "core/math/quantile.hpp"
#include "core/reverse/reverse_simulator.hpp"
#include "core/search/predecessor.hpp"
#include "core/tasks/contact_heading.hpp"
#include "core/threads/cpu_clock.hpp"
#include "nodes/config/config.hpp"
#include "tests/bench/arguments.hpp"

namespace rtg::bench {
namespace {

constexpr double kPushed = 0.5;    // least displacement of an object in the pushes drawn [m]
constexpr double kDragged = 0.05;  // ... and in a solution that drags [m]
constexpr double kMiss = 0.1;      // largest replay gap of a solution that counts as found [m]
constexpr int kWalk = 20;          // pushes from one start at most
constexpr std::size_t kTogether = 48;
constexpr double kFoundGate = 0.95;

struct Options {
  SolverOptions solver;
  std::size_t count = 200;
  std::vector<std::string> files;
};

/// Returns the largest displacement of an object [m].
double largest_displacement(const Poses& a, const Poses& b) {
  double most = 0.0;
  for (std::size_t k = 1; k < a.size(); ++k)
    most = std::max(most, (a[k].position() - b[k].position()).norm());
  return most;
}

/// A push of Box2D.
struct TruePush {
  reverse::ReverseJob job;
  double displacement = 0.0;  // largest_displacement() [m]
};

/// Draws pushes from contact-seeking walks.
std::vector<TruePush> draw_pushes(const tasks::Task& task, const forward::Simulator& box2d,
                                  std::size_t count) {
  Rng rng(1);
  std::vector<TruePush> pushes;
  while (pushes.size() < count) {
    Poses state = jittered_start(task, task.start_jitter, rng);
    for (int step = 0; step < kWalk && pushes.size() < count; ++step) {
      const int action = contact_heading(task, state, rng);
      const forward::PushOutcome after = box2d.push(state, action);
      if (!after.ok) break;
      const double displacement = largest_displacement(state, after.end);
      if (displacement >= kPushed) pushes.push_back({{after.end, action}, displacement});
      state = after.end;
    }
  }
  return pushes;
}

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

Tally solve(const tasks::Task& task, const Options& options) {
  const auto& [reverse, physics] = options.solver;
  const forward::Box2dSimulator box2d(task.scene, task.push, physics);
  const std::vector<TruePush> pushes = draw_pushes(task, box2d, options.count);
  const reverse::ReverseSimulator simulator(task.scene, physics, task.push, reverse);
  Tally tally;
  for (std::size_t first = 0; first < pushes.size(); first += kTogether) {
    const auto some = std::span(pushes).subspan(first, std::min(kTogether, pushes.size() - first));
    std::vector<reverse::ReverseJob> jobs;
    for (const TruePush& push : some) jobs.push_back(push.job);
    const double begin = threads::thread_cpu_s();
    const std::vector<reverse::ReverseResult> results = simulator.solve(jobs);
    tally.cpu_s += threads::thread_cpu_s() - begin;
    for (std::size_t k = 0; k < jobs.size(); ++k) count(some[k], results[k], box2d, tally);
  }
  return tally;
}

void print(const std::string& task, const Tally& tally, std::size_t count) {
  std::printf("%-16s %6zu %6d %6d %6d %6.2f %7.0f %7.0f %12.3g ", task.c_str(), count, tally.drags,
              tally.found, tally.whole, quantile(tally.ways, 0.5), quantile(tally.iterations, 0.5),
              quantile(tally.iterations, 0.9),
              tally.found > 0 ? 1e3 * tally.cpu_s / tally.found : INFINITY);
  for (int status = 0; status < reverse::kSolveStatusCount; ++status)
    if (const int number = tally.ends[static_cast<std::size_t>(status)])
      std::printf(" %s %d", name(static_cast<reverse::SolveStatus>(status)).data(), number);
  std::printf("\n");
  std::fflush(stdout);
}

/// Applies the flag at the beginning of `words`. Returns how many words it took: 0 if it is wrong.
std::size_t apply(std::span<char* const> words, Options& options) {
  const std::string_view word = words[0];
  if (!word.starts_with("--")) {
    options.files.emplace_back(word);
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
  std::printf("%-16s %6s %6s %6s %6s %6s %7s %7s %12s\n", "", "pushes", "drag", "found", "whole",
              "way", "median", "p90", "CPU/found ms");
  bool passed = true;
  for (const std::string& file : options.files) {
    const tasks::Task task = config::load_config(file).task;
    const Tally tally = solve(task, options);
    print(task.name, tally, options.count);
    passed = passed && tally.found >= kFoundGate * static_cast<double>(options.count);
  }
  const bool gated = options.solver.reverse.preset == reverse::ReversePreset::kDefault;
  return gated && !passed ? 1 : 0;
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
