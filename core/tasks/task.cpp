#include "core/tasks/task.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/world/separation.hpp"

namespace rtg::tasks {
namespace {

constexpr int kAttempts = 1000;  // draws of drawn_start()

bool movable_object(const Task& task, std::size_t body) {
  return body > 0 && !task.scene.bodies[body].fixed;
}

/// Returns a body that is outside the arena and not fixed.
std::optional<std::size_t> first_outside(const Task& task, const Poses& poses) {
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (!task.scene.bodies[i].fixed && !in_arena(poses[i], task.push)) return i;
  return std::nullopt;
}

/// Returns `poses` if they can be a start; nothing otherwise, see jittered().
std::optional<Poses> if_legal(const Task& task, Poses poses, Refusals& refusals) {
  poses = to_single(with_closed_joints(task.scene, std::move(poses)));
  Refusals found;
  if (const auto outside = first_outside(task, poses))
    found.count({Refusal::Kind::kNoRoom, *outside, *outside});
  else if (const auto pair = first_overlap(task.scene, poses, kStartClearance))
    found.count({Refusal::Kind::kNoRoom, pair->first, pair->second});
  else if (succeeded(task, poses))
    found.count({Refusal::Kind::kSolved});
  else
    return poses;
  refusals.count_main(found);
  return std::nullopt;
}

/// Moves each tree of joints, and each body without joints, as one: `placed` (i, pose) returns the
/// new pose of its root.
template <class Placed>
Poses with_moved_trees(const Task& task, Poses poses, Placed placed) {
  const std::vector<std::size_t> roots = roots_of(task.scene);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (roots[i] != i || task.scene.bodies[i].fixed) continue;
    const Pose from = poses[i], to = placed(i, from);
    for (std::size_t j = 0; j < poses.size(); ++j)
      if (roots[j] == i) poses[j] = carried(poses[j], from, to);
  }
  return poses;
}

/// Returns the pose of a root, shifted unless it is that of the robot.
Pose shifted(std::size_t i, Pose pose, double amplitude, Rng& rng) {
  if (i == 0) return pose;
  pose.x += rng.uniform(-amplitude, amplitude);
  pose.y += rng.uniform(-amplitude, amplitude);
  return pose;
}

/// See jittered().
std::optional<Poses> shifted_start(const Task& task, const Poses& start, double amplitude, Rng& rng,
                                   Refusals& refusals) {
  if (amplitude <= 0.0) return start;
  Poses poses = with_moved_trees(task, start, [&](std::size_t i, const Pose& from) {
    return shifted(i, from, amplitude, rng);
  });
  return if_legal(task, std::move(poses), refusals);
}

/// Draws one state for drawn_start(). Returns nothing if it is not legal.
std::optional<Poses> try_start(const Task& task, double amplitude, Rng& rng, Refusals& refusals) {
  if (task.start_ranges.empty()) return shifted_start(task, task.start, amplitude, rng, refusals);
  Poses poses = with_moved_trees(task, task.layout, [&](std::size_t i, const Pose& from) {
    const std::optional<StartRange>& range = task.start_ranges[i];
    return range ? drawn_from(*range, rng) : shifted(i, from, amplitude, rng);
  });
  return if_legal(task, std::move(poses), refusals);
}

}  // namespace

Pose drawn_from(const StartRange& range, Rng& rng) {
  const Vector2d x = moved_into(range.region, Vector2d::Zero(), rng);
  return {x.x(), x.y(), rng.uniform(range.least, range.most)};
}

std::optional<Poses> jittered(const Task& task, const Poses& start, double amplitude, Rng& rng) {
  Refusals refusals;
  return shifted_start(task, start, amplitude, rng, refusals);
}

Poses layout_around(const Task& task, const Poses& poses) {
  if (task.start_ranges.empty()) return task.start;
  return with_moved_trees(task, task.layout, [&](std::size_t i, const Pose& from) {
    return task.start_range(i) ? poses[i] : from;
  });
}

bool robot_is_turned(const Task& task) {
  const StartRange* range = task.start_range(0);
  return range && range->most > range->least && task.scene.bodies[0].shape.symmetry() > 0.0;
}

bool succeeded(const Task& task, const Poses& poses) {
  return std::ranges::all_of(task.goal,
                             [&](const GoalTerm& term) { return holds(term, task, poses); });
}

std::vector<float> observation(const Task& task, const Poses& poses) {
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(observation_size(task)));
  const auto append = [&out](double value) { out.push_back(static_cast<float>(value)); };
  const auto append_turn = [&append](double angle) {
    const auto [c, s] = turn_of(angle);
    append(c);
    append(s);
  };
  const double unit = position_unit(task), nearby = relative_unit(task);
  const Pose& robot = poses[0];
  append(robot.x / unit);
  append(robot.y / unit);
  if (robot_is_turned(task)) {
    append_turn(robot.theta);
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!movable_object(task, i)) continue;
    append(poses[i].x / unit);
    append(poses[i].y / unit);
    append_turn(poses[i].theta);
    append((poses[i].x - robot.x) / nearby);
    append((poses[i].y - robot.y) / nearby);
  }
  for (const Joint& joint : task.scene.joints) {
    const double value = joint_value(joint, poses);
    if (joint.type == JointType::kPrismatic) append(value / nearby);
    if (joint.type != JointType::kRevolute) continue;
    append(turn_of(value).s);
    append(turn_of(value).c);
  }
  return out;
}

int observation_size(const Task& task) {
  int size = robot_is_turned(task) ? 4 : 2;
  for (const Joint& joint : task.scene.joints)
    size += joint.type == JointType::kRevolute ? 2 : joint.type == JointType::kPrismatic ? 1 : 0;
  for (std::size_t i = 1; i < task.scene.size(); ++i)
    if (movable_object(task, i)) size += 6;
  return size;
}

std::optional<Poses> drawn_start(const Task& task, double amplitude, Rng& rng, Refusals* refusals) {
  Refusals own;
  Refusals& counts = refusals ? *refusals : own;
  for (int k = 0; k < kAttempts; ++k)
    if (std::optional<Poses> poses = try_start(task, amplitude, rng, counts)) return poses;
  return std::nullopt;
}

Poses jittered_start(const Task& task, double amplitude, Rng& rng) {
  Refusals refusals;
  if (std::optional<Poses> poses = drawn_start(task, amplitude, rng, &refusals))
    return *std::move(poses);
  throw std::invalid_argument("no legal start among " + std::to_string(kAttempts) +
                              " random draws with objects shifted by up to " +
                              std::to_string(amplitude * task.units.length) + " m; " +
                              main_reason(refusals, task.scene) + "; legal: a smaller shift");
}

bool allows_jitter(const Task& task, double amplitude, Refusals* refusals) {
  Refusals own;
  Refusals& counts = refusals ? *refusals : own;
  Rng rng(1);
  for (int draw = 0, legal = 0; draw < 250; ++draw)
    if (try_start(task, amplitude, rng, counts) && ++legal == 5) return true;
  return false;
}

}  // namespace rtg::tasks
