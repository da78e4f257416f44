// Generates transitions in one process and prints the report without its samples. Exit status 2 if
// an argument is not one of
//
//   generate_bench FILE [--seed S] [--threads T] [SECTION.KEY=VALUE]...
//
// FILE is a configuration, as for ./run.sh; two threads if nothing is said.

#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/config/config.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/support/generated.hpp"

namespace rtg::bench {
namespace {

using bench::read_number;

struct Options {
  std::string file;
  std::vector<std::string> overrides;
  std::uint64_t seed = 1;
  int threads = 2;
};

/// Reads the arguments and returns whether they are legal; tells the first that is not.
bool read(std::span<char* const> arguments, Options& options) {
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string_view word = arguments[k];
    const std::string_view value = k + 1 < arguments.size() ? arguments[k + 1] : "";
    bool legal = true;
    if (word == "--seed")
      legal = read_number(value, std::uint64_t{0}, ~std::uint64_t{0}, options.seed);
    else if (word == "--threads")
      legal = read_number(value, 1, 1024, options.threads);
    else if (word.starts_with("-"))
      legal = false;
    else if (options.file.empty())
      options.file = word;
    else
      options.overrides.emplace_back(word);
    if (!legal) {
      std::fprintf(stderr, "generate_bench: %s is no argument, or its value is missing or wrong\n",
                   arguments[k]);
      return false;
    }
    k += word.starts_with("-");
  }
  return true;
}

void print_progress(const search::Progress& p) {
  std::fprintf(stderr, "%-10s layer %2d  %6ld of %6ld  contact %.2f  starts reached %ld\n",
               p.phase.c_str(), p.layer, p.transitions, p.target, p.contact_share,
               p.starts_reached);
}

void run(const Options& options) {
  const config::Config config = config::load_config(options.file, options.overrides);
  auto report = nlohmann::ordered_json::parse(
      to_json(testing::generated(config, options.seed, options.threads, print_progress)));
  report.erase("replay_gaps");
  report.erase("nodes");
  std::printf("%s\n", report.dump().c_str());
}

}  // namespace
}  // namespace rtg::bench

int main(int argc, char** argv) {
  rtg::bench::Options options;
  if (!rtg::bench::read({argv + 1, argv + argc}, options)) return 2;
  try {
    rtg::bench::run(options);
    return 0;
  } catch (const rtg::config::ConfigError& e) {
    std::fprintf(stderr, "generate_bench: %s\n", e.what());
    return 2;
  }
}
