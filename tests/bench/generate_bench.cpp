// Generates transitions in one process and prints the report without its samples. Exit status 2 if
// an argument is not one of
//
//   generate_bench [--task gathering|gathering_hard] [--reverse rrbs|naive] [--transitions N]
//                  [--seed S] [--threads T] [--set NAME NUMBER]...
//
// Without them it does what ./run.sh does, with two threads; --set takes numbers of the sections
// search and reverse.

#include <algorithm>
#include <cstdio>
#include <optional>
#include <span>
#include <string_view>

#include "core/search/simulators.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using bench::read_number;

struct Options {
  Task task = testing::gathering();
  SearchConfig search;
  ReverseConfig reverse;
  std::uint64_t seed = 1;
  int threads = 2;
};

bool set(Options& options, std::string_view name, std::string_view value) {
  bench::Setter setter{name, value};
  options.search.visit(setter);
  options.reverse.visit(setter);
  return setter.done;
}

/// Whether `flag` takes one value and this is one.
bool apply(Options& options, std::string_view flag, std::string_view value) {
  if (flag == "--seed")
    return read_number(value, std::uint64_t{0}, ~std::uint64_t{0}, options.seed);
  if (flag == "--threads") return read_number(value, 1, 1024, options.threads);
  if (flag == "--transitions") return set(options, "transitions", value);
  if (flag == "--task" && (value == "gathering" || value == "gathering_hard")) {
    options.task = value == "gathering" ? testing::gathering() : testing::gathering_hard();
    return true;
  }
  const auto mode = std::ranges::find(kReverseModes, value);
  if (flag != "--reverse" || mode == kReverseModes.end()) return false;
  options.search.reverse = static_cast<ReverseMode>(mode - kReverseModes.begin());
  return true;
}

/// None if an argument is illegal, which it tells.
std::optional<Options> parsed(std::span<char* const> arguments) {
  Options options;
  for (std::size_t k = 0; k < arguments.size();) {
    const std::string_view flag = arguments[k];
    const std::size_t values = flag == "--set" ? 2 : 1;
    if (k + values >= arguments.size() ||
        !(values == 2 ? set(options, arguments[k + 1], arguments[k + 2])
                      : apply(options, flag, arguments[k + 1]))) {
      std::fprintf(stderr, "generate_bench: %s is no argument, or its value is missing or wrong\n",
                   arguments[k]);
      return std::nullopt;
    }
    k += values + 1;
  }
  return options;
}

void print_progress(const Progress& p) {
  std::fprintf(stderr, "%-10s layer %2d  %6ld of %6ld  contact %.2f  start region %ld\n",
               p.phase.c_str(), p.layer, p.transitions, p.target, p.contact_share, p.start_region);
}

int run(const Options& options) {
  const Task& task = options.task;
  GenerationSeams seams =
      in_process_seams(reverse_solver(task, {}, options.reverse, options.search.reverse),
                       forward_replay(task, {}), options.threads);
  seams.store = [](std::span<const Transition>) {};
  seams.progress = print_progress;
  GenerationReport report = generate(task, options.search, options.seed, seams);
  report.replay_gaps.clear();
  report.nodes.clear();
  std::printf("%s\n", to_json(report).c_str());
  return 0;
}

}  // namespace
}  // namespace rtg

int main(int argc, char** argv) {
  const auto options = rtg::parsed({argv + 1, argv + argc});
  return options ? rtg::run(*options) : 2;
}
