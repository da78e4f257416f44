#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/search/transition.hpp"
#include "core/tasks/task.hpp"

namespace rtg::search {

/// Pseudo-action without a push: the bodies come to rest while the robot is held.
inline constexpr int kSettle = -1;

/// A request to simulate the push `action` from the state `start`.
struct ReplayJob {
  Poses start;
  int action = 0;  // or kSettle

  bool operator==(const ReplayJob&) const = default;
};

struct ReplayResult {
  Poses end;
  bool ok = false;     // as PushOutcome::ok
  double cpu_s = 0.0;  // thread CPU time [s]; not a function of the job, unlike the rest
};

/// Returns the transition of `push`, which ends in the state `end`.
inline Transition transition(const tasks::Task& task, const ReplayJob& push, const Poses& end,
                             Source source) {
  return {push.start, push.action, end, succeeded(task, end), source};
}

/// Interfaces for reverse solves (SolveBatch) and forward simulation (ReplayBatch) of many jobs.
/// They return one result per job, in job order. Implementations may use threads or worker
/// processes. All must give bitwise the same results.
using SolveBatch =
    std::function<std::vector<reverse::ReverseResult>(std::span<const reverse::ReverseJob>)>;
using ReplayBatch = std::function<std::vector<ReplayResult>(std::span<const ReplayJob>)>;

/// Answers a single replay job; pure, and safe to call from several threads at once.
using ReplayOne = std::function<ReplayResult(const ReplayJob&)>;

/// Receives transitions in sequence order; the k-th transition of a run has sequence number k.
using TransitionSink = std::function<void(std::span<const Transition>)>;

/// A line of the progress display.
struct Progress {
  std::string phase;  // "tree 1", "trees 2 to 5", "plan 3", "random walks"
  int layer = 0;      // of `depth`
  int depth = 0;
  long transitions = 0;  // stored so far
  long target = 0;       // to be stored in all
  double contact_share = 0.0;
  long starts_reached = 0;  // starts_reached() by the trees so far
};

/// The functions that generate() receives from its caller.
struct GenerationSeams {
  SolveBatch solve;
  ReplayBatch replay;
  TransitionSink store;            // receives every transition, in order
  std::vector<double> paces = {};  // of pushes of each body (rtg::paces()); empty: all 1
  // Both may be empty. They are called for each layer of a search or wave of walks.
  std::function<void(const Progress&)> progress = {};
  std::function<bool()> cancelled = {};
};

}  // namespace rtg::search
