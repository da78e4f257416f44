// Solves the committed reverse problems on one core and prints what became of them:
//
//   reverse_corpus FOLDER [--preset default|paper] [--every N] [--failures] [--set NAME VALUE]...
//
// --preset: stands above the --set before it; --every N: only each N-th problem; --failures: lists
// the unsolved ones, by cause; --set takes keys of the sections reverse and physics. The gates hold
// for each task, over the problems in which the robot meets a body, but for the share that
// converges, which is of all tasks together. Which problems have a solution is unknown; true_pushes
// has some that have one. Exit status 1 if a gate fails, 2 for bad input.

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/quantile.hpp"
#include "core/reverse/reverse_simulator.hpp"
#include "core/threads/cpu_clock.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/corpus.hpp"
#include "tests/bench/gate.hpp"

namespace rtg::bench {
namespace {

struct Options {
  SolverOptions solver;
  std::size_t every = 1;
  bool failures = false;
};

constexpr std::size_t kTogether = 48;

/// A problem's line in the file, and what became of it; its share of the CPU time.
struct Outcome {
  std::string task;
  std::size_t line = 0;
  Difficulty difficulty = Difficulty::kFree;
  reverse::SolveStatus status = reverse::SolveStatus::kNonFinite;
  int iterations = 0;
  double cpu_ms = 0.0;

  bool decided() const {
    return has_predecessors(status) || status == reverse::SolveStatus::kInfeasible;
  }
};

/// How the problems of a group ended.
struct Tally {
  int count = 0, converged = 0, infeasible = 0;
  double cpu_ms = 0.0;
  std::vector<int> iterations;  // of the decided ones

  void add(const Outcome& o) {
    ++count;
    converged += has_predecessors(o.status);
    infeasible += o.status == reverse::SolveStatus::kInfeasible;
    cpu_ms += o.cpu_ms;
    if (o.decided()) iterations.push_back(o.iterations);
  }

  double share(int part) const { return static_cast<double>(part) / static_cast<double>(count); }
};

/// Problems of one task and difficulty are solved together, kTogether at a time.
std::vector<Outcome> solve(const Corpus& corpus, const Options& options) {
  std::map<std::pair<std::string, Difficulty>, std::vector<std::size_t>> alike;
  for (std::size_t k = 0; k < corpus.problems.size(); k += options.every)
    alike[{corpus.problems[k].task, corpus.problems[k].difficulty}].push_back(k);
  std::vector<Outcome> outcomes;
  for (const auto& [kind, lines] : alike) {
    const tasks::Task& task = corpus.tasks.at(kind.first);
    const reverse::ReverseSimulator simulator(task.scene, options.solver.physics, task.push,
                                              options.solver.reverse);
    for (std::size_t first = 0; first < lines.size(); first += kTogether) {
      std::vector<reverse::ReverseJob> jobs;
      for (std::size_t k = first; k < std::min(first + kTogether, lines.size()); ++k)
        jobs.push_back(corpus.problems[lines[k]].job);
      const double begin = threads::thread_cpu_s();
      const std::vector<reverse::ReverseResult> results = simulator.solve(jobs);
      const double share =
          1e3 * (threads::thread_cpu_s() - begin) / static_cast<double>(jobs.size());
      for (std::size_t k = 0; k < jobs.size(); ++k)
        outcomes.push_back({kind.first, lines[first + k] + 1, kind.second, results[k].status,
                            results[k].iterations, share});
    }
  }
  return outcomes;
}

using Tallies = std::map<std::string, Tally>;

/// Counts the problems in groups of which `name_of` gives the names.
template <class NameOf>
Tallies counted(std::span<const Outcome> outcomes, NameOf name_of) {
  Tallies tallies;
  for (const Outcome& o : outcomes) tallies[name_of(o)].add(o);
  return tallies;
}

void print(const Tallies& tallies) {
  std::printf("%-15s %6s %9s %10s %9s %7s %7s %9s\n", "", "count", "converged", "infeasible",
              "undecided", "median", "p90", "CPU [ms]");
  for (const auto& [name, t] : tallies)
    std::printf("%-15s %6d %9d %10d %9d %7.0f %7.0f %9.2f\n", name.c_str(), t.count, t.converged,
                t.infeasible, t.count - t.converged - t.infeasible, quantile(t.iterations, 0.5),
                quantile(t.iterations, 0.9), t.cpu_ms / t.count);
  std::printf("\n");
}

/// Share of problems decided within so many iterations, and within so much time.
void print_profile(std::span<const Outcome> outcomes) {
  const auto share = [&](auto within) {
    return static_cast<double>(std::ranges::count_if(
               outcomes, [&](const Outcome& o) { return o.decided() && within(o); })) /
           static_cast<double>(outcomes.size());
  };
  std::printf("decided within\n");
  for (const int limit : {2, 5, 10, 15, 20, 30, 50, 100, 200})
    std::printf("  %3d iterations %.3f\n", limit,
                share([limit](const Outcome& o) { return o.iterations <= limit; }));
  for (const double limit : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0})
    std::printf("  %5.1f ms CPU %.3f\n", limit,
                share([limit](const Outcome& o) { return o.cpu_ms <= limit; }));
}

void print_failures(std::span<const Outcome> outcomes) {
  std::printf("\nundecided: cause, line of problems.txt, difficulty, iterations\n");
  for (int status = 0; status < reverse::kSolveStatusCount; ++status)
    for (const Outcome& o : outcomes)
      if (!o.decided() && static_cast<int>(o.status) == status)
        std::printf("  %-18s %4zu %-7s %4d\n", name(o.status).data(), o.line,
                    kDifficulties[static_cast<std::size_t>(o.difficulty)].data(), o.iterations);
}

/// Goals of a corpus; jointed problems have their own.
struct Goals {
  const char* name;
  double converged, iterations_median, iterations_p90;
};
constexpr Goals kGoals{"corpus", 0.9, 20, 50}, kJointedGoals{"corpus_joints", 0.75, 30, 60};

bool gates(const Tallies& by_task, const Goals& goals) {
  bool passed = true;
  Tally all;
  for (const auto& [task, t] : by_task) {
    all.count += t.count;
    all.converged += t.converged;
    const std::string name = std::string(goals.name) + "." + task;
    passed &= gate(name + ".decided", t.share(t.converged + t.infeasible), Bound::kAtLeast, 0.99);
    passed &= gate(name + ".iterations_median", quantile(t.iterations, 0.5), Bound::kAtMost,
                   goals.iterations_median);
    passed &= gate(name + ".iterations_p90", quantile(t.iterations, 0.9), Bound::kAtMost,
                   goals.iterations_p90);
  }
  return gate(std::string(goals.name) + ".converged", all.share(all.converged), Bound::kAtLeast,
              goals.converged) &&
         passed;
}

/// Applies the flag at the beginning of `words`. Returns how many words it took: 0 if it is wrong.
std::size_t apply(std::span<char* const> words, Options& options) {
  const std::string_view flag = words[0];
  if (flag == "--failures") {
    options.failures = true;
    return 1;
  }
  if (flag == "--every")
    return words.size() >= 2 &&
                   read_number(words[1], std::size_t{1}, std::size_t{100000}, options.every)
               ? 2
               : 0;
  return apply(words, options.solver);
}

int run(const std::filesystem::path& folder, const Options& options) {
  const Corpus corpus = read_corpus(folder);
  const std::vector<Outcome> outcomes = solve(corpus, options);
  print(counted(outcomes, [](const Outcome& o) {
    return std::string(kDifficulties[static_cast<std::size_t>(o.difficulty)]);
  }));
  std::vector<Outcome> pushing;
  std::ranges::copy_if(outcomes, std::back_inserter(pushing),
                       [](const Outcome& o) { return o.difficulty != Difficulty::kFree; });
  const Tallies by_task = counted(pushing, [](const Outcome& o) { return o.task; });
  std::printf("in which the robot meets a body:\n");
  print(by_task);
  print_profile(pushing);
  if (options.failures) print_failures(outcomes);
  std::printf("\n");
  const bool jointed = std::ranges::any_of(
      corpus.tasks, [](const auto& task) { return !task.second.scene.joints.empty(); });
  return gates(by_task, jointed ? kJointedGoals : kGoals) ? 0 : 1;
}

}  // namespace
}  // namespace rtg::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "reverse_corpus: name the folder of the corpus, tests/bench/corpus\n");
    return 2;
  }
  const auto options =
      rtg::bench::read_options<rtg::bench::Options>("reverse_corpus", {argv + 2, argv + argc});
  if (!options) return 2;
  try {
    return rtg::bench::run(argv[1], *options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "reverse_corpus: %s\n", error.what());
    return 2;
  }
}
