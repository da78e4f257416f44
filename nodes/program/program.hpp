#pragma once

#include <string>
#include <vector>

#include "core/tasks/task.hpp"
#include "nodes/bus/bus.hpp"
#include "nodes/jobs/services.hpp"

namespace rtg::program {

/// Command-line arguments of a node program, without its name.
using Words = std::vector<std::string>;

/// Implements main() of a program: watches signals, checks the number of words and runs `body`.
/// Returns the exit status. An exception is reported in one line on stderr. It makes the status 2
/// for bad input (std::invalid_argument, ConfigError), else 1. `usage`: the names of the words,
/// optional ones in brackets, as in "CONFIG.yaml KEY [NUMBER]".
int run(int argc, char** argv, const std::string& usage, int (*body)(const Words&));

/// Prints a line on stdout that begins with the name of the program. A program prints one
/// when it starts, when others first need it, and when it ends without an error.
void say(const std::string& words);

/// Says that the program waits for `whom` of the run of `bus`; before that, the bus's warning.
void say_waiting(const bus::Bus& bus, const std::string& whom);

/// Parses `word` as a whole number ≥ 0. Throws std::invalid_argument with `name` in the message if
/// it is none.
int parse_number(const std::string& word, const std::string& name);

jobs::TaskShape shape_of(const tasks::Task& task);

}  // namespace rtg::program
