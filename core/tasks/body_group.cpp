#include "core/tasks/body_group.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace rtg::tasks {
namespace {

/// A range of the values of a joint; empty if least > most.
struct Values {
  double least = 0.0, most = 0.0;
};

/// Returns the part of `all` outside of `range`: that below or above it at random, each as likely
/// as it is wide.
Values outside(const Values& all, const JointIn& range, Rng& rng) {
  const double below = std::max(0.0, std::min(all.most, range.least) - all.least);
  const double above = std::max(0.0, all.most - std::max(all.least, range.most));
  const bool is_below = rng.uniform(0.0, below + above) < below;
  return is_below ? Values{all.least, all.least + below}
                  : Values{std::max(all.least, range.most), all.most};
}

/// Returns values that the limits of `joint` and the goal allow. Returns nothing if there are none,
/// and counts the term that leaves none.
std::optional<Values> values_in_goal(GoalDraw& draw, const Joint& joint) {
  const double span =
      joint.type == JointType::kPrismatic ? 2.0 * draw.task.push.arena : std::numbers::pi;
  Values values{std::isfinite(joint.lower) ? joint.lower : -span,
                std::isfinite(joint.upper) ? joint.upper : span};
  for (std::size_t k = 0; k < draw.goal.size(); ++k) {
    const GoalTerm& term = draw.goal[k];
    if (!concerns(term, draw.task.scene, joint)) continue;
    const auto& range = std::get<JointIn>(term.condition);
    values = term.negated
                 ? outside(values, range, draw.rng)
                 : Values{std::max(values.least, range.least), std::min(values.most, range.most)};
    if (values.least > values.most) {
      draw.refusals.count({Refusal::Kind::kTerm, k});
      return std::nullopt;
    }
  }
  return values;
}

void move(BodyGroup& group, const Vector2d& by) {
  for (const std::size_t i : group.members) {
    group.poses[i].x += by.x();
    group.poses[i].y += by.y();
  }
}

/// Returns whether the position of `group` decides if `term`, which has the condition MeanIn,
/// holds. It does if `term` applies to a body of the group and all its other bodies are placed
/// already.
bool determines_mean(const BodyGroup& group, const GoalTerm& term, const GoalDraw& draw) {
  const auto concerned = [&](std::size_t i) { return concerns(term, draw.task.scene, i); };
  for (std::size_t i = 1; i < draw.task.scene.size(); ++i)
    if (concerned(i) && !draw.state.placed[i] && !std::ranges::count(group.members, i))
      return false;
  return std::ranges::any_of(group.members, concerned);
}

/// Returns how little room a term on a body alone leaves to its pose: less is tighter. A pose is
/// tighter than a region, of which the narrower is tighter, and that than an angle.
std::pair<int, double> room_of(const GoalTerm& term) {
  if (term.negated || std::holds_alternative<AngleIn>(term.condition)) return {2, 0.0};
  if (const auto* in = std::get_if<CentreIn>(&term.condition)) return {1, half_width(in->region)};
  if (const auto* stays = std::get_if<Stays>(&term.condition)) return {1, stays->distance};
  return {0, 0.0};
}

}  // namespace

std::size_t positioned_member(const GoalDraw& draw, const BodyGroup& group) {
  std::size_t tightest = group.root;
  std::pair<int, double> least{3, 0.0};
  for (const std::size_t i : group.members)
    for (const GoalTerm& term : draw.goal)
      if (is_of_one_body(term) && concerns(term, draw.task.scene, i) && room_of(term) < least) {
        tightest = i;
        least = room_of(term);
      }
  return tightest;
}

bool draw_joint_values(GoalDraw& draw, BodyGroup& group) {
  const Scene& scene = draw.task.scene;
  for (const std::size_t n : root_first(scene)) {
    const Joint& joint = scene.joints[n];
    const auto child = static_cast<std::size_t>(joint.child);
    if (!std::ranges::count(group.members, child)) continue;
    const auto values = values_in_goal(draw, joint);
    if (!values) return false;
    set_joint_value(joint, draw.rng.uniform(values->least, values->most), group.poses);
  }
  return true;
}

void move_to(BodyGroup& group, std::size_t member, const Pose& to) {
  const Pose from = group.poses[member];
  for (const std::size_t i : group.members) group.poses[i] = carried(group.poses[i], from, to);
}

void aim_at_means(GoalDraw& draw, BodyGroup& group) {
  const Scene& scene = draw.task.scene;
  for (const GoalTerm& term : draw.goal) {
    const auto* mean = std::get_if<MeanIn>(&term.condition);
    if (!mean || term.negated || !determines_mean(group, term, draw)) continue;
    const auto concerned = [&](std::size_t i) { return concerns(term, scene, i); };
    std::size_t all = 0;
    for (std::size_t i = 1; i < scene.size(); ++i) all += concerned(i);
    const auto ours = static_cast<double>(std::ranges::count_if(group.members, concerned));
    const Vector2d by = moved_into(mean->region, point_in_arena(draw), draw.rng) -
                        centroid_of(term, scene, group.poses);
    move(group, static_cast<double>(all) / ours * by);
  }
}

bool try_add(GoalDraw& draw, const BodyGroup& group) {
  PartialState trial = draw.state;
  for (const std::size_t i : group.members) {
    const Pose& pose = group.poses[i];
    if (!draw.task.scene.bodies[i].fixed) {
      if (!meets_terms_of(draw, i, group.poses)) return false;
      const bool within = in_arena(pose, draw.task.push);
      if (const auto other = within ? blocker(draw.task, trial, i, pose) : std::nullopt;
          other || !within) {
        draw.refusals.count({Refusal::Kind::kNoRoom, i, other.value_or(i)});
        return false;
      }
    }
    trial.poses[i] = pose;
    trial.placed[i] = true;
  }
  draw.state = std::move(trial);
  return true;
}

}  // namespace rtg::tasks
