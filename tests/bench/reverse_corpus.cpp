// Solves the committed reverse problems on one core and prints what became of them:
//
//   reverse_corpus FOLDER [--preset default|paper] [--every N] [--failures] [--set NAME VALUE]...
//
// --preset: stands above the --set before it; --every N: only each N-th problem; --failures: lists
// the unsolved ones, by cause; --set takes keys of the sections reverse and physics. Exit status
// 1 if a gate fails, 2 for bad input.

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>

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
  std::size_t line = 0;
  Difficulty difficulty = Difficulty::kFree;
  reverse::SolveStatus status = reverse::SolveStatus::kNonFinite;
  int iterations = 0;
  double cpu_ms = 0.0;

  bool decided() const {
    return status == reverse::SolveStatus::kConverged ||
           status == reverse::SolveStatus::kInfeasible;
  }
};

std::vector<int> iterations_of(std::span<const Outcome> outcomes, std::optional<Difficulty> of) {
  std::vector<int> found;
  for (const Outcome& o : outcomes)
    if (o.decided() && (!of || o.difficulty == *of)) found.push_back(o.iterations);
  return found;
}

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
        outcomes.push_back(
            {lines[first + k] + 1, kind.second, results[k].status, results[k].iterations, share});
    }
  }
  return outcomes;
}

void print_by_difficulty(std::span<const Outcome> outcomes) {
  std::printf("%-8s %6s %9s %10s %9s %7s %7s %9s\n", "", "count", "converged", "infeasible",
              "undecided", "median", "p90", "CPU [ms]");
  for (std::size_t k = 0; k < kDifficulties.size(); ++k) {
    std::array<int, reverse::kSolveStatusCount> ends{};
    int count = 0;
    double cpu = 0.0;
    for (const Outcome& o : outcomes) {
      if (static_cast<std::size_t>(o.difficulty) != k) continue;
      ++count;
      ++ends[static_cast<std::size_t>(o.status)];
      cpu += o.cpu_ms;
    }
    const int converged = ends[static_cast<std::size_t>(reverse::SolveStatus::kConverged)];
    const int infeasible = ends[static_cast<std::size_t>(reverse::SolveStatus::kInfeasible)];
    const std::vector<int> iterations = iterations_of(outcomes, static_cast<Difficulty>(k));
    std::printf("%-8s %6d %9d %10d %9d %7.0f %7.0f %9.2f\n", kDifficulties[k].data(), count,
                converged, infeasible, count - converged - infeasible, quantile(iterations, 0.5),
                quantile(iterations, 0.9), count > 0 ? cpu / count : 0.0);
  }
}

/// Share of problems decided within so many iterations, and within so much time.
void print_profile(std::span<const Outcome> outcomes) {
  const auto share = [&](auto within) {
    return static_cast<double>(std::ranges::count_if(
               outcomes, [&](const Outcome& o) { return o.decided() && within(o); })) /
           static_cast<double>(outcomes.size());
  };
  std::printf("\ndecided within\n");
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
constexpr Goals kGoals{"corpus", 0.9, 20, 50}, kJointedGoals{"corpus_joints", 0.85, 30, 60};

bool gates(std::span<const Outcome> outcomes, const Goals& goals) {
  const auto decided = std::ranges::count_if(outcomes, &Outcome::decided);
  const double share = static_cast<double>(decided) / static_cast<double>(outcomes.size());
  const auto solved =
      std::ranges::count(outcomes, reverse::SolveStatus::kConverged, &Outcome::status);
  const double converged = static_cast<double>(solved) / static_cast<double>(outcomes.size());
  const std::vector<int> iterations = iterations_of(outcomes, std::nullopt);
  const std::string name = goals.name;
  std::printf("\n");
  const bool all[] = {gate(name + ".decided", share, Bound::kAtLeast, 0.99),
                      gate(name + ".converged", converged, Bound::kAtLeast, goals.converged),
                      gate(name + ".iterations_median", quantile(iterations, 0.5), Bound::kAtMost,
                           goals.iterations_median),
                      gate(name + ".iterations_p90", quantile(iterations, 0.9), Bound::kAtMost,
                           goals.iterations_p90)};
  return std::ranges::all_of(all, [](bool passed) { return passed; });
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
  print_by_difficulty(outcomes);
  print_profile(outcomes);
  if (options.failures) print_failures(outcomes);
  const bool jointed = std::ranges::any_of(
      corpus.tasks, [](const auto& task) { return !task.second.scene.joints.empty(); });
  return gates(outcomes, jointed ? kJointedGoals : kGoals) ? 0 : 1;
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
