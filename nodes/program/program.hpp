#pragma once

#include <string>
#include <vector>

#include "core/tasks/task.hpp"
#include "nodes/jobs/services.hpp"

namespace rtg::program {

/// Command-line arguments of a node program, without its name.
using Words = std::vector<std::string>;

/// Implements main() of a node program: watches signals, checks the number of words, runs `body`
/// and returns its exit status. Reports an exception in one line on stderr and returns 2 for bad
/// input (std::invalid_argument, ConfigError), else 1. `usage`: the names of the words, optional
/// ones in brackets, as in "CONFIG.yaml RUN [NUMBER]".
int run(int argc, char** argv, const std::string& usage, int (*body)(const Words&));

/// Returns the whole number ≥ 0 that `word` spells. Throws std::invalid_argument, with `name` in
/// the message, if `word` is none.
int parse_number(const std::string& word, const std::string& name);

jobs::TaskShape shape_of(const tasks::Task& task);

}  // namespace rtg::program
