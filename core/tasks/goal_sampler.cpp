#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/tasks/placement.hpp"
#include "core/tasks/task.hpp"

namespace rtg::tasks {
namespace {

constexpr int kAttempts = 1000;
constexpr int kProposals = 50;         // tries to place a body (or a tree of joints) in one attempt
constexpr double kBesideShare = 0.5;   // share of proposals that put a body beside another one
constexpr double kBesideGap = 0.1;     // largest gap to that body [m]
constexpr double kBehindShare = 0.75;  // probability that the robot stands as after a push
constexpr double kBehindGap = 0.03;    // robot as after a push: largest gap above kClearance [m]
constexpr double kFreeRange = 3.0;     // otherwise: largest offset from a body in x and in y [m]
constexpr double kTwoPi = 2.0 * std::numbers::pi;

Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Moves `x` into the region of `term`, shrunk by kGoalSpare. In a disc the result is uniform and
/// does not depend on `x`. For a half-plane, `x` moves along the normal to a random distance behind
/// the line, at most its old distance. So points close to the line are likelier.
Vector2d moved_into(const GoalTerm& term, const Vector2d& x, Rng& rng) {
  if (term.region == GoalTerm::Region::kDisc) {
    const double r = (term.radius - kGoalSpare) * std::sqrt(rng.uniform(0.0, 1.0));
    return term.centre + r * unit(rng.uniform(0.0, kTwoPi));
  }
  const double depth = term.offset - kGoalSpare - term.normal.dot(x);
  return x + (depth - rng.uniform(0.0, 1.0) * std::abs(depth)) * term.normal;
}

Vector2d point_in_arena(const Task& task, Rng& rng) {
  const double a = task.push.arena;
  const double x = rng.uniform(-a, a);
  return {x, rng.uniform(-a, a)};
}

/// Returns whether `x` lies in all goal regions for the centre of `body`, shrunk by kGoalSpare.
bool in_target(const Task& task, std::size_t body, const Vector2d& x) {
  return std::ranges::all_of(task.goal, [&](const GoalTerm& term) {
    return term.subject != GoalTerm::Subject::kEvery || !concerns(term, task.scene, body) ||
           contains(term, x, kGoalSpare);
  });
}

/// Draws a uniform point of the arena and moves it into the goal regions for the centre of body
/// `i`.
Vector2d point_in_goal(const Task& task, std::size_t i, Rng& rng) {
  Vector2d x = point_in_arena(task, rng);
  for (const GoalTerm& term : task.goal)
    if (term.subject == GoalTerm::Subject::kEvery && concerns(term, task.scene, i))
      x = moved_into(term, x, rng);
  return x;
}

/// Returns the angles of the outward normals of all straight edges of the parts, in the body frame.
std::vector<double> normal_angles(const Shape& shape) {
  std::vector<double> angles;
  for (const auto& [core, radius] : shape.parts())
    for (std::size_t k = 0; core.size() > 1 && k < core.size(); ++k) {
      const Vector2d edge = core.vertices[(k + 1) % core.size()] - core.vertices[k];
      angles.push_back(std::atan2(-edge.x(), edge.y()));
    }
  return angles;
}

/// Proposes a pose of body `i` beside a random other body. Body `i` slides towards that body from a
/// random side, face to face or at a random angle with equal odds. Returns nothing if that body is
/// not placed yet or if slide() fails.
std::optional<Pose> beside(const Task& task, const PartialState& state, std::size_t i, Rng& rng) {
  const auto j = static_cast<std::size_t>(1 + rng.below(static_cast<int>(task.scene.size()) - 1));
  if (j == i || !state.placed[j]) return std::nullopt;
  const Shape &mine = task.scene.bodies[i].shape, &other = task.scene.bodies[j].shape;
  const std::vector<double> ours = normal_angles(mine), theirs = normal_angles(other);
  double side = rng.uniform(0.0, kTwoPi), theta = rng.uniform(-std::numbers::pi, std::numbers::pi);
  if (rng.uniform(0.0, 1.0) < 0.5 && !ours.empty() && !theirs.empty()) {
    const auto one_of = [&rng](const std::vector<double>& angles) {
      return angles[static_cast<std::size_t>(rng.below(static_cast<int>(angles.size())))];
    };
    const double their = one_of(theirs), our = one_of(ours);
    side = state.poses[j].theta + their;
    theta = std::remainder(side + std::numbers::pi - our, kTwoPi);
  }
  const double reach = mine.radius() + other.radius() + kBesideGap;
  const double shift = rng.uniform(-0.5, 0.5) * other.radius();
  const Vector2d from =
      state.poses[j].position() + reach * unit(side) + shift * unit(side + kTwoPi / 4.0);
  return slide(task, state, i,
               {.from = {from.x(), from.y(), theta},
                .heading = -unit(side),
                .gap = rng.uniform(kClearance, kBesideGap),
                .range = 2.0 * reach});
}

/// Bodies that are placed together, with their intended poses.
struct Group {
  std::size_t root;
  std::vector<std::size_t> members;  // root included
  Poses poses;                       // of all bodies
};

void move(Group& group, const Vector2d& by) {
  for (const std::size_t i : group.members) {
    group.poses[i].x += by.x();
    group.poses[i].y += by.y();
  }
}

/// Returns whether the position of `group` decides if `term`, a kCentroid term, holds. It does if
/// `term` applies to a body of the group and all its other bodies are placed already.
bool determines_mean(const Group& group, const GoalTerm& term, const Task& task,
                     const PartialState& state) {
  const auto concerned = [&](std::size_t i) { return concerns(term, task.scene, i); };
  if (term.subject != GoalTerm::Subject::kCentroid) return false;
  for (std::size_t i = 1; i < task.scene.size(); ++i)
    if (concerned(i) && !state.placed[i] && !std::ranges::count(group.members, i)) return false;
  return std::ranges::any_of(group.members, concerned);
}

/// For each term whose mean the group determines (determines_mean()), moves the group so that the
/// mean centre lies in the region.
void aim_at_centroids(const Task& task, const PartialState& state, Group& group, Rng& rng) {
  for (const GoalTerm& term : task.goal) {
    if (!determines_mean(group, term, task, state)) continue;
    const auto concerned = [&](std::size_t i) { return concerns(term, task.scene, i); };
    std::size_t all = 0;
    for (std::size_t i = 1; i < task.scene.size(); ++i) all += concerned(i);
    const auto ours = static_cast<double>(std::ranges::count_if(group.members, concerned));
    const Vector2d by = moved_into(term, point_in_arena(task, rng), rng) -
                        centroid_of(term, task.scene, group.poses);
    move(group, static_cast<double>(all) / ours * by);
  }
}

/// Adds the bodies of `group` to `state` if their poses are legal; returns whether they are. Each
/// movable body must lie in its goal regions and in the arena. It must be clear of the bodies
/// placed before and of the rest of the group.
bool try_add(const Task& task, PartialState& state, const Group& group) {
  PartialState trial = state;
  for (const std::size_t i : group.members) {
    const Pose& pose = group.poses[i];
    if (!task.scene.bodies[i].fixed &&
        (!in_target(task, i, pose.position()) || !in_arena(pose, task.push) ||
         !is_clear(task, trial, i, pose)))
      return false;
    trial.poses[i] = pose;
    trial.placed[i] = true;
  }
  state = std::move(trial);
  return true;
}

bool place_object(const Task& task, PartialState& state, std::size_t i, Rng& rng) {
  for (int k = 0; k < kProposals; ++k) {
    Group group{i, {i}, state.poses};
    if (rng.uniform(0.0, 1.0) < kBesideShare) {
      const std::optional<Pose> pose = beside(task, state, i, rng);
      if (!pose) continue;
      group.poses[i] = *pose;
    } else {
      const Vector2d x = point_in_goal(task, i, rng);
      group.poses[i] = {x.x(), x.y(), rng.uniform(-std::numbers::pi, std::numbers::pi)};
      aim_at_centroids(task, state, group, rng);
    }
    if (try_add(task, state, group)) return true;
  }
  return false;
}

/// Returns the least and the largest angle that the limits of `joint` and the goal allow [rad].
/// Returns nothing if there is no such angle.
std::optional<std::pair<double, double>> angles_in_goal(const Task& task, const Joint& joint) {
  double least = std::isfinite(joint.lower) ? joint.lower : -std::numbers::pi;
  double most = std::isfinite(joint.upper) ? joint.upper : std::numbers::pi;
  for (const GoalTerm& term : task.goal) {
    if (!concerns(term, task.scene, joint)) continue;
    least = std::max(least, term.least + kGoalSpare);
    most = std::min(most, term.most - kGoalSpare);
  }
  if (least > most) return std::nullopt;
  return std::pair{least, most};
}

/// Returns the member by whose centre place_tree() positions the group: the first that has a goal
/// region of its own, otherwise the root.
std::size_t positioned_member(const Task& task, const Group& group) {
  for (const std::size_t i : group.members)
    for (const GoalTerm& term : task.goal)
      if (term.subject == GoalTerm::Subject::kEvery && concerns(term, task.scene, i)) return i;
  return group.root;
}

/// Gives each joint of the group a random angle that its limits and the goal allow. Returns false
/// if a joint has no such angle.
bool draw_joint_angles(const Task& task, Group& group, Rng& rng) {
  for (const std::size_t n : root_first(task.scene)) {
    const Joint& joint = task.scene.joints[n];
    const auto child = static_cast<std::size_t>(joint.child);
    if (!std::ranges::count(group.members, child)) continue;
    const auto angles = angles_in_goal(task, joint);
    if (!angles) return false;
    group.poses[child].theta = group.poses[static_cast<std::size_t>(joint.parent)].theta +
                               rng.uniform(angles->first, angles->second);
  }
  group.poses = with_closed_joints(task.scene, std::move(group.poses));
  return true;
}

/// Places a tree of jointed bodies: draws the joint angles, then moves the tree into its goal
/// regions. A fixed root stays. Returns whether one of kProposals tries succeeded.
bool place_tree(const Task& task, PartialState& state, const Group& tree, Rng& rng) {
  for (int k = 0; k < kProposals; ++k) {
    Group group = tree;
    const bool fixed = task.scene.bodies[group.root].fixed;
    if (!fixed) group.poses[group.root].theta = rng.uniform(-std::numbers::pi, std::numbers::pi);
    if (!draw_joint_angles(task, group, rng)) return false;
    if (!fixed) {
      const std::size_t positioned = positioned_member(task, group);
      move(group, point_in_goal(task, positioned, rng) - group.poses[positioned].position());
      aim_at_centroids(task, state, group, rng);
    }
    if (try_add(task, state, group)) return true;
  }
  return false;
}

/// Draws a pose of the robot as after a push: it slides along a random heading towards a random
/// body until it meets a body. Returns nothing if it meets none.
std::optional<Pose> robot_behind(const Task& task, const PartialState& state, Rng& rng) {
  const auto j = static_cast<std::size_t>(1 + rng.below(static_cast<int>(task.scene.size()) - 1));
  const Vector2d d = direction(rng.below(task.push.headings), task.push);
  const double span = task.scene.bodies[0].shape.radius() + task.scene.bodies[j].shape.radius();
  const Vector2d from = state.poses[j].position() - (span + task.push.stride) * d +
                        rng.uniform(-0.8, 0.8) * span * Vector2d(-d.y(), d.x());
  return slide(task, state, 0,
               {.from = {from.x(), from.y(), task.start[0].theta},
                .heading = d,
                .gap = kClearance + rng.uniform(0.0, kBehindGap),
                .range = 2.0 * (span + task.push.stride)});
}

bool place_robot(const Task& task, PartialState& state, Rng& rng) {
  const bool behind = rng.uniform(0.0, 1.0) < kBehindShare;
  for (int k = 0; k < kProposals; ++k) {
    std::optional<Pose> pose;
    if (behind) {
      pose = robot_behind(task, state, rng);
    } else {
      const auto j =
          static_cast<std::size_t>(1 + rng.below(static_cast<int>(task.scene.size()) - 1));
      pose = Pose{state.poses[j].x + rng.uniform(-kFreeRange, kFreeRange),
                  state.poses[j].y + rng.uniform(-kFreeRange, kFreeRange), task.start[0].theta};
    }
    if (!pose || !in_arena(*pose, task.push)) continue;
    if (!is_clear(task, state, 0, *pose)) continue;
    state.poses[0] = *pose;
    return true;
  }
  return false;
}

bool place_objects(const Task& task, PartialState& state, Rng& rng) {
  const std::vector<std::size_t> roots = roots_of(task.scene);
  for (std::size_t i = 1; i < task.scene.size(); ++i) {
    if (roots[i] != i) continue;
    Group group{i, {}, state.poses};
    for (std::size_t j = 1; j < task.scene.size(); ++j)
      if (roots[j] == i) group.members.push_back(j);
    const bool alone = group.members.size() == 1;
    if (alone && task.scene.bodies[i].fixed) continue;
    if (alone ? !place_object(task, state, i, rng) : !place_tree(task, state, group, rng))
      return false;
  }
  return true;
}

std::optional<Poses> attempt(const Task& task, Rng& rng) {
  PartialState state{task.start, std::vector<bool>(task.scene.size(), false)};
  for (std::size_t i = 1; i < task.scene.size(); ++i) state.placed[i] = task.scene.bodies[i].fixed;
  if (!place_objects(task, state, rng)) return std::nullopt;
  if (task.scene.size() > 1 && !place_robot(task, state, rng)) return std::nullopt;
  for (const GoalTerm& term : task.goal)  // try_add() has checked the kEvery terms
    if (term.subject != GoalTerm::Subject::kEvery &&
        !holds(term, task.scene, state.poses, kGoalSpare))
      return std::nullopt;
  return to_single(std::move(state.poses));
}

}  // namespace

std::optional<Poses> sample_goal(const Task& task, Rng& rng) {
  for (int k = 0; k < kAttempts; ++k)
    if (std::optional<Poses> poses = attempt(task, rng)) return poses;
  return std::nullopt;
}

}  // namespace rtg::tasks
