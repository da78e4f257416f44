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
  double randomisation = 0.0;  // how far domain randomisation goes: object positions ± this [m]

  /// The plain numbers; the rest has a structure of its own.
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

/// Bodies closer than this are in contact for Box2D; start states keep clear of each other by it
/// [m].
inline constexpr double kStartClearance = 0.02;

/// Says whether the goal holds in `poses`, with every region shrunk by `tighten` [m], [rad].
bool succeeded(const Task& task, const Poses& poses, double tighten = 0.0);

/// The learner's view, float32, lengths / 8 m: robot x, y; per movable body x, y, cos θ, sin θ,
/// x - x_robot, y - y_robot; per joint sin, cos of its angle. Fixed body order carries the class.
std::vector<float> observation(const Task& task, const Poses& poses);
int observation_size(const Task& task);

/// `start` with every movable object's position moved by ± amplitude in x and y (uniform), bodies
/// that joints connect as one (those on a fixed body stay). Nothing if objects then overlap or lie
/// outside the arena, or the goal holds. Poses are to_single(). With amplitude 0 `start` as it is.
std::optional<Poses> jittered(const Task& task, const Poses& start, double amplitude, Rng& rng);

/// The task's start, jittered(). Throws std::invalid_argument if no draw of 1000 was legal: see
/// allows_jitter().
Poses jittered_start(const Task& task, double amplitude, Rng& rng);

/// Says whether at least 5 of 250 draws of jittered_start() are legal. Where one in 50 is, a
/// thousand in a row are not with probability 2e-9.
bool allows_jitter(const Task& task, double amplitude);

/// The margin by which a sampled goal state meets the goal with to spare [m], [rad].
inline constexpr double kGoalSpare = 0.05;

/// A layout that satisfies the goal with kGoalSpare: each body somewhere in its region
/// or beside one that is already there, corner or face towards it, at random angles; bodies that
/// joints connect as one; the robot, heading as at the start, just behind one as after a push (3 of
/// 4) or clear of all; the last of those whose mean a term speaks of where it brings that into its
/// region. Fixed bodies stay, the others are in the arena. Poses are to_single(). Nearly at rest:
/// settle it. Empty if none was found in 1000 attempts.
std::optional<Poses> sample_goal(const Task& task, Rng& rng);

}  // namespace rtg::tasks
