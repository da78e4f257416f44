// Generates Gathering transitions in one process and prints the report without its samples, then
// the time.
//
//   generate_bench [--reverse naive] [--transitions N] [--seed S] [--threads T] [--set NAME
//   VALUE]...

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>

#include "core/search/simulators.hpp"
#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;

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
  SearchConfig search;
  ReverseConfig reverse;
  std::uint64_t seed = 1;
  int threads = 2;
};

Options parsed(int argc, char** argv) {
  Options options;
  options.search.reverse = ReverseMode::kNaive;
  for (int k = 1; k + 1 < argc; k += 2) {
    const std::string flag = argv[k];
    if (flag == "--seed") options.seed = std::strtoull(argv[k + 1], nullptr, 10);
    if (flag == "--reverse")
      options.search.reverse =
          std::strcmp(argv[k + 1], "rrbs") == 0 ? ReverseMode::kRrbs : ReverseMode::kNaive;
    if (flag == "--threads") options.threads = std::atoi(argv[k + 1]);
    if (flag == "--transitions") options.search.transitions = std::atoi(argv[k + 1]);
    if (flag != "--set" || k + 2 >= argc) continue;
    Setter setter{argv[k + 1], std::atof(argv[k + 2])};
    options.search.visit(setter);
    options.reverse.visit(setter);
    if (!setter.found) std::fprintf(stderr, "--set %s: no such key\n", argv[k + 1]);
    ++k;
  }
  return options;
}

void print_progress(const Progress& p) {
  std::fprintf(stderr, "%-10s layer %2d  %6ld of %6ld  contact %.2f  start region %ld\n",
               p.phase.c_str(), p.layer, p.transitions, p.target, p.contact_share, p.start_region);
}

int run(const Options& options) {
  const Task task = gathering();
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

int main(int argc, char** argv) { return rtg::run(rtg::parsed(argc, argv)); }
