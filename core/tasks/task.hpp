#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math/rng.hpp"
#include "core/tasks/goal.hpp"
#include "core/tasks/refusals.hpp"
#include "core/tasks/units.hpp"
#include "core/world/push.hpp"

namespace rtg::tasks {

/// Where a body starts: with its centre anywhere in a region, at any angle of a range (uniform).
struct StartRange {
  Region region;                   // a disc or a polygon
  double least = 0.0, most = 0.0;  // θ [rad]

  bool operator==(const StartRange&) const = default;
};

/// Returns a pose drawn from `range`.
Pose drawn_from(const StartRange& range, Rng& rng);

/// A sparse-reward task: the reward is 1 and the episode terminates when the goal holds; otherwise
/// the reward is 0.
struct Task {
  std::string name;
  Units units;  // of all lengths and densities here; they are written as [m] and [kg/m²] below
  Scene scene;
  Poses start;                                          // nominal start state
  std::vector<std::optional<StartRange>> start_ranges;  // per body, of those without a fixed place
  Poses layout;                                         // with ranges: all bodies, in their middles
  std::vector<GoalTerm> goal;                           // all must hold
  PushConfig push;
  int horizon = 60;            // pushes after which an episode is truncated
  double discount = 0.8;       // γ
  double start_jitter = 0.1;   // largest shift of objects in evaluation starts, x and y [m]
  double randomisation = 0.0;  // the same for domain randomisation [m]

  /// Returns the range that the start of body `i` is drawn from; nullptr if it has a fixed place.
  const StartRange* start_range(std::size_t i) const {
    return start_ranges.empty() || !start_ranges[i] ? nullptr : &*start_ranges[i];
  }

  /// Shows the numeric settings to `v`, with their bounds and help texts.
  template <class Visitor>
  void visit(Visitor& v) {
    v.integer("horizon", horizon, 1, 100000, "largest number of pushes in an episode");
    v.number("discount", discount, 0.01, 0.9999,
             "discount factor of the reward per push, if train.discount is 0");
    v.length("start_jitter", start_jitter, 0.0, 10.0,
             "largest x, y shift of objects in evaluation/search starts [m]");
    v.length("randomisation", randomisation, 0.0, 10.0,
             "domain randomisation (randomise): largest x, y object shift [m]");
  }
};

/// Distance that start states keep between bodies [m]. Box2D treats closer bodies as in contact.
inline constexpr double kStartClearance = 0.02;

/// Returns whether the goal holds in `poses`.
bool succeeded(const Task& task, const Poses& poses);

/// Units of lengths in an observation [m]. Relative positions tell contacts, which differ by
/// hundredths of an arena: with all lengths in units of `arena`, Gathering takes 1.8 times as
/// many gradient steps to be learned (three seeds).
inline double position_unit(const Task& task) { return task.push.arena / 2.0; }
inline double relative_unit(const Task& task) { return longest_stride(task.push) / 2.0; }

/// Returns the learner's observation [observation_size]:
///
///   x, y of the robot, and cos θ, sin θ if robot_is_turned(),
///   x, y, cos θ, sin θ, x - x_robot, y - y_robot of each movable object,
///   sin φ, cos φ of each revolute joint, s of each prismatic one.
///
/// Positions are in units of position_unit(), relative ones and s in those of relative_unit().
/// Bodies and joints are in the order of the scene, so an entry always belongs to the same object.
std::vector<float> observation(const Task& task, const Poses& poses);
/// Returns whether episodes differ in the angle of the robot, and its shape is no disc.
bool robot_is_turned(const Task& task);
int observation_size(const Task& task);

/// Returns `start` with the movable objects shifted at random, by at most `amplitude` [m] in x and
/// in y (uniform). Jointed bodies are shifted as one; those on a fixed root stay. The poses are
/// rounded by to_single(). Returns nothing if bodies are then closer than kStartClearance, an
/// object is outside the arena, or the goal holds. With amplitude 0, returns `start` unchanged.
std::optional<Poses> jittered(const Task& task, const Poses& start, double amplitude, Rng& rng);

/// Returns the layout that the starts are drawn around: the bodies that have a range, with what
/// hangs on them by joints, as they lie in `poses`; all others in their places.
Poses layout_around(const Task& task, const Poses& poses);

/// Draws a start state of the task: the bodies that have a range are drawn from it, the others
/// are jittered(). Jointed bodies move as one. Returns nothing if 1000 draws in a row are illegal;
/// allows_jitter() tests for that in advance. Adds to `refusals`, if not null.
std::optional<Poses> drawn_start(const Task& task, double amplitude, Rng& rng,
                                 Refusals* refusals = nullptr);

/// Returns the drawn_start(). Throws std::invalid_argument if there is none.
Poses jittered_start(const Task& task, double amplitude, Rng& rng);

/// Returns whether drawn_start() can be relied on to find a legal start: at least 5 of 250 test
/// draws are legal. If 1 draw in 50 is legal, 1000 in a row are illegal with probability 2e-9. Adds
/// to `refusals`, if not null.
bool allows_jitter(const Task& task, double amplitude, Refusals* refusals = nullptr);

}  // namespace rtg::tasks
