#include "core/tasks/goal_sampler.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/math/draws.hpp"
#include "core/tasks/body_group.hpp"
#include "core/tasks/contact_placement.hpp"
#include "core/tasks/goal_draw.hpp"
#include "core/tasks/robot_placement.hpp"

namespace rtg::tasks {
namespace {

constexpr int kAttempts = 1000;
constexpr double kBesideShare = 0.5;    // share of proposals that put a body beside another one
constexpr double kTouchingShare = 0.9;  // the same if the goal asks for that

/// Returns whether a term says where body `i` is to lie.
bool has_target(const GoalDraw& draw, std::size_t i) {
  return std::ranges::any_of(draw.goal, [&](const GoalTerm& term) {
    return !term.negated && concerns(term, draw.task.scene, i) &&
           (std::holds_alternative<PoseNear>(term.condition) ||
            std::holds_alternative<Covers>(term.condition));
  });
}

/// Returns the probability with which a body is proposed beside another one: 0 if a term says where
/// it is to lie, more than usual if a term says that it is to touch.
double beside_share(const GoalDraw& draw, std::size_t i) {
  if (has_target(draw, i)) return 0.0;
  return is_to_touch(draw, i) ? kTouchingShare : kBesideShare;
}

/// Returns a random member that is to touch or to be touched; nothing if there is none or a term
/// says where a member is to lie.
std::optional<std::size_t> member_to_touch(GoalDraw& draw, const BodyGroup& group) {
  std::vector<std::size_t> found;
  for (const std::size_t i : group.members) {
    if (has_target(draw, i)) return std::nullopt;
    if (is_to_touch(draw, i)) found.push_back(i);
  }
  if (found.empty()) return std::nullopt;
  return drawn(found, 1, draw.rng)[0];
}

bool place_object(GoalDraw& draw, std::size_t i) {
  const double share = beside_share(draw, i);
  draw.refusals = {};
  for (int k = 0; k < kProposals; ++k) {
    BodyGroup group{i, {i}, draw.state.poses};
    if (draw.rng.uniform(0.0, 1.0) < share) {
      std::optional<Pose> pose = in_touch(draw, i);
      if (!pose) pose = beside_any(draw, i);
      if (!pose) continue;
      group.poses[i] = *pose;
    } else {
      group.poses[i] = pose_in_goal(draw, i);
      aim_at_means(draw, group);
    }
    if (try_add(draw, group)) return true;
  }
  return false;
}

/// Moves a tree of jointed bodies as one until a member that is to touch another body does, else to
/// where the goal asks for one of its members.
void move_tree(GoalDraw& draw, BodyGroup& group) {
  const auto touching = member_to_touch(draw, group);
  if (touching && draw.rng.uniform(0.0, 1.0) < kTouchingShare)
    if (const std::optional<Pose> pose = in_touch(draw, *touching))
      return move_to(group, *touching, *pose);
  const std::size_t positioned = positioned_member(draw, group);
  move_to(group, positioned, pose_in_goal(draw, positioned));
  aim_at_means(draw, group);
}

/// Places a tree of jointed bodies: draws the values of its joints, then moves the tree. A fixed
/// root stays. Returns whether one of kProposals tries succeeded.
bool place_tree(GoalDraw& draw, const BodyGroup& tree) {
  draw.refusals = {};
  for (int k = 0; k < kProposals; ++k) {
    BodyGroup group = tree;
    if (!draw_joint_values(draw, group)) return false;
    if (!draw.task.scene.bodies[group.root].fixed) move_tree(draw, group);
    if (try_add(draw, group)) return true;
  }
  return false;
}

bool place_objects(GoalDraw& draw) {
  const Scene& scene = draw.task.scene;
  const std::vector<std::size_t> roots = roots_of(scene);
  for (std::size_t i = 1; i < scene.size(); ++i) {
    if (roots[i] != i) continue;
    BodyGroup group{i, {}, draw.state.poses};
    for (std::size_t j = 1; j < scene.size(); ++j)
      if (roots[j] == i) group.members.push_back(j);
    const bool alone = group.members.size() == 1;
    if (alone && scene.bodies[i].fixed) continue;
    if (alone ? !place_object(draw, i) : !place_tree(draw, group)) return false;
  }
  return true;
}

bool place_robot_beside(GoalDraw& draw) {
  if (draw.task.scene.size() == 1 || place_robot(draw)) return true;
  draw.refusals = {};
  draw.refusals.count({Refusal::Kind::kNoRobot});
  return false;
}

std::optional<Poses> attempt(const Task& task, const std::vector<GoalTerm>& goal, Rng& rng,
                             Refusals& refusals) {
  GoalDraw draw{task, goal, rng, {task.start, std::vector<bool>(task.scene.size(), false)}};
  for (std::size_t i = 1; i < task.scene.size(); ++i)
    draw.state.placed[i] = task.scene.bodies[i].fixed;
  if (place_objects(draw) && place_robot_beside(draw) && meets_goal(draw))
    return to_single(std::move(draw.state.poses));
  refusals.count_main(draw.refusals);
  return std::nullopt;
}

}  // namespace

std::optional<Poses> sample_goal(const Task& task, Rng& rng, Refusals* refusals) {
  std::vector<GoalTerm> goal;
  for (const GoalTerm& term : task.goal) goal.push_back(tightened(term, task.scene));
  Refusals own;
  Refusals& counts = refusals ? *refusals : own;
  for (int k = 0; k < kAttempts; ++k)
    if (std::optional<Poses> poses = attempt(task, goal, rng, counts)) return poses;
  return std::nullopt;
}

}  // namespace rtg::tasks
