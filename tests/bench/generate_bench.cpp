// Generates transitions in one process and prints the report without its samples. Exit status 2 if
// an argument is not one of
//
//   generate_bench [--task gathering|gathering_hard] [--reverse rrbs|naive] [--transitions N]
//                  [--seed S] [--threads T] [--set NAME VALUE]...

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/search/simulators.hpp"
#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

/// Sets the number called `name`; the config's visitor.
struct Setter {
  std::string name;
  double value = 0.0;
  bool found = false;

  void number(const char* key, double& field, double, double, const char*) { set(key, field); }
  void integer(const char* key, int& field, int, int, const char*) { set(key, field); }
  void flag(const char* key, bool& field, const char*) { set(key, field); }
  template <class Enum, class Names>
  void choice(const char* key, Enum& field, const Names&, const char*) {
    set(key, field);
  }

  template <class Field>
  void set(const char* key, Field& field) {
    if (name != key) return;
    field = static_cast<Field>(value);
    found = true;
  }
};

struct Options {
  Task task = testing::gathering();
  SearchConfig search;
  ReverseConfig reverse;
  std::uint64_t seed = 1;
  int threads = 2;
};

bool set(Options& options, const char* name, const char* value) {
  Setter setter{name, std::atof(value)};
  options.search.visit(setter);
  options.reverse.visit(setter);
  return setter.found;
}

/// Whether `flag` takes one value and this is one.
bool apply(Options& options, std::string_view flag, std::string_view value) {
  const int number = std::atoi(value.data());
  if (flag == "--task" && (value == "gathering" || value == "gathering_hard"))
    options.task = value == "gathering" ? testing::gathering() : testing::gathering_hard();
  else if (flag == "--reverse" && (value == "rrbs" || value == "naive"))
    options.search.reverse = value == "rrbs" ? ReverseMode::kRrbs : ReverseMode::kNaive;
  else if (flag == "--seed" && number >= 0)
    options.seed = static_cast<std::uint64_t>(number);
  else if (flag == "--threads" && number > 0)
    options.threads = number;
  else if (flag == "--transitions" && number > 0)
    options.search.transitions = number;
  else
    return false;
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
