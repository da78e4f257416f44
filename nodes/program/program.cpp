#include "nodes/program/program.hpp"

#include <errno.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "nodes/config/config_error.hpp"
#include "nodes/program/shutdown.hpp"

namespace rtg::program {
namespace {

int fail(const std::string& program, const std::exception& error, int status) {
  std::fprintf(stderr, "%s: %s\n", program.c_str(), error.what());
  return status;
}

void check_count(const Words& words, const std::string& usage) {
  const auto most = static_cast<std::size_t>(std::ranges::count(usage, ' ')) + 1;
  const auto optional = static_cast<std::size_t>(std::ranges::count(usage, '['));
  if (words.size() > most || words.size() + optional < most)
    throw std::invalid_argument("legal words: " + usage);
}

}  // namespace

int run(int argc, char** argv, const std::string& usage, int (*body)(const Words&)) {
  const std::string program = std::filesystem::path(argv[0]).filename();
  try {
    watch_signals();
    const Words words(argv + 1, argv + argc);
    check_count(words, usage);
    return body(words);
  } catch (const config::ConfigError& error) {
    return fail(program, error, 2);
  } catch (const std::invalid_argument& error) {
    return fail(program, error, 2);
  } catch (const std::exception& error) {
    return fail(program, error, 1);
  }
}

void say(const std::string& words) {
  std::printf("%s: %s\n", program_invocation_short_name, words.c_str());
  std::fflush(stdout);
}

void say_waiting(const bus::Bus& bus, const std::string& whom) {
  if (const std::string warning = bus.warning(); !warning.empty())
    std::fprintf(stderr, "%s\n", warning.c_str());
  say("waits for " + whom + " of run " + bus.run());
}

int parse_number(const std::string& word, const std::string& name) {
  int number = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (error != std::errc() || stop != end || number < 0)
    throw std::invalid_argument(name + " '" + word + "'; legal: a whole number from 0 on");
  return number;
}

jobs::TaskShape shape_of(const tasks::Task& task) {
  return {static_cast<int>(task.scene.size()), action_count(task.push)};
}

}  // namespace rtg::program
