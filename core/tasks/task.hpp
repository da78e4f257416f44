#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math/rng.hpp"
#include "core/tasks/goal.hpp"
#include "core/world/push.hpp"

namespace rtg::tasks {

/// A sparse-reward task: reward +1 and termination when the goal holds, nothing otherwise.
struct Task {
  std::string name;
  Scene scene;
  Poses start;                 // nominal start state
  std::vector<GoalTerm> goal;  // all must hold
  PushConfig push;
  int horizon = 60;            // episode length, a truncation
  double discount = 0.8;       // γ
  double start_jitter = 0.1;   // evaluation starts: object positions ± this [m]
  double randomisation = 0.0;  // domain randomisation: object positions ± this [m]

  /// Visits the plain numbers alone.
  template <class Visitor>
  void visit(Visitor& v) {
    v.integer("horizon", horizon, 1, 100000, "pushes of an episode at most");
    v.number("discount", discount, 0.01, 0.9999, "of the reward per push");
    v.number("start_jitter", start_jitter, 0.0, 10.0,
             "evaluation starts: object positions +- this [m]");
    v.number("randomisation", randomisation, 0.0, 10.0,
             "domain randomisation, where asked for: object positions +- this [m]");
  }
};

/// Distance that start states keep between bodies [m]. For Box2D, closer bodies are in contact.
inline constexpr double kStartClearance = 0.02;

/// Returns whether the goal holds in `poses`, with every region shrunk by `tighten` [m], [rad].
bool succeeded(const Task& task, const Poses& poses, double tighten = 0.0);

/// Returns the learner's observation, float32, with lengths divided by 8 m: robot x, y; per movable
/// object x, y, cos θ, sin θ, x - x_robot, y - y_robot; per joint sin, cos of its angle. The order
/// of bodies is fixed and so identifies their classes.
std::vector<float> observation(const Task& task, const Poses& poses);
int observation_size(const Task& task);

/// Returns `start` with every movable object moved by ± amplitude in x and y (uniform). Bodies that
/// joints connect move as one; those on a fixed body stay. Poses are to_single(). Returns nothing
/// if bodies then come closer than kStartClearance, objects lie outside the arena, or the goal
/// holds. With amplitude 0, returns `start` as it is.
std::optional<Poses> jittered(const Task& task, const Poses& start, double amplitude, Rng& rng);

/// Returns the task's start, jittered(). Throws std::invalid_argument if none of 1000 draws is
/// legal; see allows_jitter().
Poses jittered_start(const Task& task, double amplitude, Rng& rng);

/// Returns whether at least 5 of 250 draws of jittered() are legal. If one in 50 draws is legal,
/// the probability that 1000 in a row are not is 2e-9.
bool allows_jitter(const Task& task, double amplitude);

/// Margin by which a state of sample_goal() satisfies the goal [m], [rad].
inline constexpr double kGoalSpare = 0.05;

/// Draws a layout that satisfies the goal with margin kGoalSpare. Each body is placed somewhere in
/// its region at a random angle, or beside a placed body, with a corner or a face towards it.
/// Bodies that joints connect are placed as one. If a term applies to the mean of several bodies,
/// the last of them is placed so that the mean lies in the region. The robot, heading as at the
/// start, stands just behind a body as after a push (3 of 4) or near one but clear of all. Fixed
/// bodies stay, the others are in the arena. Poses are to_single() and only nearly at rest, so they
/// must be settled. Returns nothing if 1000 attempts fail.
std::optional<Poses> sample_goal(const Task& task, Rng& rng);

}  // namespace rtg::tasks
