#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/tasks/task.hpp"
#include "core/world/physics_config.hpp"
#include "core/world/selection.hpp"

namespace rtg::bench {

/// Names what makes a reverse problem hard, the worst that applies.
enum class Difficulty {
  kFree,    // the robot meets nobody
  kSingle,  // it may drag one object
  kMulti,   // two or more
  kCorner,  // a vertex meets a vertex
  kJam,     // three contacts among the bodies that may move, or one with a fixed body
};
inline constexpr std::array<std::string_view, 5> kDifficulties{"free", "single", "multi", "corner",
                                                               "jam"};

/// Returns the bodies that take part in a problem.
Selection part_of(const tasks::Task& task, const PhysicsConfig& physics,
                  const reverse::ReverseJob& job);

Difficulty difficulty_of(const tasks::Task& task, const PhysicsConfig& physics,
                         const reverse::ReverseJob& job);

/// A candidate that a search has asked for and pruning has let through.
struct Problem {
  std::string task;
  Difficulty difficulty = Difficulty::kFree;
  reverse::ReverseJob job;
};

/// Committed reverse problems. `folder` holds TASK.yaml and problems.txt, a line per problem:
///
///   TASK DIFFICULTY ACTION x y θ x y θ ...     poses of all bodies afterwards [m], [rad]
struct Corpus {
  std::map<std::string, tasks::Task> tasks;
  std::vector<Problem> problems;
};

/// Reads the tasks of FOLDER/TASK.yaml by name, at least one. Throws std::runtime_error,
/// ConfigError.
std::map<std::string, tasks::Task> read_tasks(const std::filesystem::path& folder);

/// Reads at least one problem. Throws std::runtime_error with file and line, ConfigError.
Corpus read_corpus(const std::filesystem::path& folder);
void write_problems(const std::filesystem::path& file, const std::vector<Problem>& problems);

}  // namespace rtg::bench
