// rtg_config FILE [--set KEY=VALUE]... (--print | --json | --check): reads and checks a
// configuration. Exit status 0, 2 for bad input, 1 for anything else.

#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "nodes/config/rtg_config.hpp"
#include "nodes/rtg_config/description.hpp"

namespace {

constexpr const char* kUsage =
    "usage: rtg_config FILE [--set KEY=VALUE]... (--print | --json | --check)";

struct Arguments {
  std::string file, mode;
  std::vector<std::string> overrides;
};

Arguments parse(const std::vector<std::string>& words) {
  Arguments found;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == "--set" && k + 1 == words.size())
      throw rtg::ConfigError("--set: nothing behind it; legal: --set KEY=VALUE");
    if (words[k] == "--set")
      found.overrides.push_back(words[++k]);
    else if (words[k] == "--print" || words[k] == "--json" || words[k] == "--check")
      found.mode = words[k];
    else if (found.file.empty() && !words[k].starts_with("--"))
      found.file = words[k];
    else
      throw rtg::ConfigError(words[k] + ": no such flag; " + kUsage);
  }
  if (found.file.empty() || found.mode.empty())
    throw rtg::ConfigError(std::string(found.file.empty() ? "no FILE" : "no mode") + "; " + kUsage);
  return found;
}

void run(const Arguments& arguments) {
  const rtg::RtgConfig config = rtg::load_config(arguments.file, arguments.overrides);
  if (arguments.mode == "--check")
    std::cout << arguments.file << ": legal\n" << rtg::description(config);
  else
    std::cout << (arguments.mode == "--json" ? rtg::config_json(config)
                                             : rtg::canonical_yaml(config));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(parse({argv + 1, argv + argc}));
    return 0;
  } catch (const rtg::ConfigError& error) {
    std::cerr << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "rtg_config: " << error.what() << '\n';
    return 1;
  }
}
