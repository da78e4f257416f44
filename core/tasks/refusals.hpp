#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "core/world/scene.hpp"

namespace rtg::tasks {

/// Why a draw of a goal state or of a start state was refused.
struct Refusal {
  enum class Kind {
    kTerm,     // goal states: term `a` of the goal did not hold
    kNoRoom,   // body `a` was nearer to body `b` than the clearance or, if a = b, out of the arena
    kNoRobot,  // goal states: there was no place for the robot
    kSolved    // start states: the goal held
  };
  Kind kind;
  std::size_t a = 0, b = 0;
  auto operator<=>(const Refusal&) const = default;
};

/// Counts of refusals.
class Refusals {
 public:
  void count(const Refusal& refusal) { ++counts_[refusal]; }

  /// Counts a try that failed for what was refused most often in its `proposals`, of which there is
  /// at least one: several refusals if they are level.
  void count_main(const Refusals& proposals);

  struct Main {
    Refusal refusal;
    double share;  // of the tries that failed
  };
  /// Returns what made most tries fail, the first of several that are level; nothing if none
  /// failed.
  std::optional<Main> main() const;

 private:
  long most() const;

  std::map<Refusal, long> counts_;
  long tries_ = 0;
};

/// Returns the term that made at least half of the tries fail; nothing if none did.
std::optional<std::size_t> main_term(const Refusals& refusals);

/// Returns what failed most often, in words to the user: "task.goal.1 did not hold in 93% of the
/// failed tries".
std::string main_reason(const Refusals& refusals, const Scene& scene);

}  // namespace rtg::tasks
