#include "core/tasks/task.hpp"

#include <algorithm>
#include <cmath>

#include "core/world/separation.hpp"

namespace rtg {
namespace {

constexpr double kLengthScale = 8.0;  // of the observation [m]
constexpr int kAttempts = 1000;

bool holds(const GoalTerm& term, const Vector2d& x, double tighten) {
  if (term.region == GoalTerm::Region::kDisc)
    return (x - term.centre).norm() <= term.radius - tighten;
  return term.normal.dot(x) <= term.offset - tighten;
}

bool movable_object(const Task& task, std::size_t body) {
  return body > 0 && !task.scene.bodies[body].fixed;
}

}  // namespace

bool applies_to(const GoalTerm& term, const Task& task, std::size_t body) {
  if (body == 0) return false;
  return term.kind == "*" ? movable_object(task, body) : term.kind == task.scene.bodies[body].kind;
}

bool in_target(const Task& task, std::size_t body, const Vector2d& x, double tighten) {
  return std::all_of(task.goal.begin(), task.goal.end(), [&](const GoalTerm& term) {
    return !applies_to(term, task, body) || holds(term, x, tighten);
  });
}

bool succeeded(const Task& task, const Poses& poses, double tighten) {
  for (std::size_t i = 1; i < poses.size(); ++i)
    if (!in_target(task, i, poses[i].position(), tighten)) return false;
  return true;
}

std::vector<float> observation(const Task& task, const Poses& poses) {
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(observation_size(task)));
  const auto append = [&out](double value) { out.push_back(static_cast<float>(value)); };
  const auto append_length = [&append](double value) { append(value / kLengthScale); };
  const Pose& robot = poses[0];
  append_length(robot.x);
  append_length(robot.y);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!movable_object(task, i)) continue;
    append_length(poses[i].x);
    append_length(poses[i].y);
    append(std::cos(poses[i].theta));
    append(std::sin(poses[i].theta));
    append_length(poses[i].x - robot.x);
    append_length(poses[i].y - robot.y);
  }
  return out;
}

int observation_size(const Task& task) {
  int size = 2;
  for (std::size_t i = 1; i < task.scene.size(); ++i)
    if (movable_object(task, i)) size += 6;
  return size;
}

std::optional<Poses> jittered_start(const Task& task, double amplitude, Rng& rng) {
  if (amplitude <= 0.0) return task.start;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Poses poses = task.start;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      if (!movable_object(task, i)) continue;
      poses[i].x += rng.uniform(-amplitude, amplitude);
      poses[i].y += rng.uniform(-amplitude, amplitude);
      poses[i] = to_single(poses[i]);
    }
    if (!first_overlap(task.scene, poses, kStartClearance) && !succeeded(task, poses)) return poses;
  }
  return std::nullopt;
}

}  // namespace rtg
