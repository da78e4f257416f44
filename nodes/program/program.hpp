#pragma once

#include <string>
#include <vector>

#include "core/tasks/task.hpp"
#include "nodes/jobs/services.hpp"

namespace rtg::program {

/// The command line of a node program.
using Words = std::vector<std::string>;

/// The whole of a node program's main(): watches signals, checks the number of words, runs `body`
/// and turns what it throws into a line on stderr and an exit status, 2 for bad input
/// (std::invalid_argument, ConfigError), 1 for the rest. `usage`: the words by name, optional ones
/// in brackets, as in "CONFIG.yaml RUN [NUMBER]".
int run(int argc, char** argv, const std::string& usage, int (*body)(const Words&));

/// A word that must be a number ≥ 0; throws std::invalid_argument that calls it `name`.
int number_word(const std::string& word, const std::string& name);

jobs::TaskShape shape_of(const tasks::Task& task);

}  // namespace rtg::program
