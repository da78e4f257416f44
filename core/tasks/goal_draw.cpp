#include "core/tasks/goal_draw.hpp"

#include <cmath>
#include <numbers>

namespace rtg::tasks {
namespace {

double drawn_angle(const AngleIn& range, double period, Rng& rng) {
  const double angle = rng.uniform(range.least, range.most);
  if (period == 0.0) return rng.uniform(-std::numbers::pi, std::numbers::pi);
  const auto turns = static_cast<int>(std::lround(2.0 * std::numbers::pi / period));
  return angle + period * rng.below(turns);
}

/// Changes the pose of a body so that it meets a condition on it alone, or comes near to that.
void aim(const Condition& condition, const Pose& start, const Shape& shape, Pose& pose, Rng& rng) {
  const double period = shape.symmetry();
  const auto place = [&pose](const Vector2d& x) {
    pose.x = x.x();
    pose.y = x.y();
  };
  if (const auto* in = std::get_if<CentreIn>(&condition)) {
    place(moved_into(in->region, pose.position(), rng));
  } else if (const auto* angle = std::get_if<AngleIn>(&condition)) {
    pose.theta = drawn_angle(*angle, period, rng);
  } else if (const auto* near = std::get_if<PoseNear>(&condition)) {
    place(moved_into(Disc{near->pose.position(), near->distance}, pose.position(), rng));
    pose.theta =
        drawn_angle({near->pose.theta - near->turn, near->pose.theta + near->turn}, period, rng);
  } else if (const auto* covers = std::get_if<Covers>(&condition)) {
    // An outline that is moved by a share of its size leaves about that share uncovered.
    const double off = (1.0 - covers->share) * rng.uniform(0.0, 1.0);
    place(moved_into(Disc{covers->pose.position(), off * shape.radius()}, pose.position(), rng));
    pose.theta = drawn_angle({covers->pose.theta - off, covers->pose.theta + off}, period, rng);
  } else if (const auto* stays = std::get_if<Stays>(&condition)) {
    place(moved_into(Disc{start.position(), stays->distance}, pose.position(), rng));
    pose.theta = start.theta + stays->distance / shape.radius() * rng.uniform(-1.0, 1.0);
  }
}

/// Returns the turn of a condition in pose_in_goal(). Later ones have the last word.
int rank(const Condition& condition) {
  if (std::holds_alternative<CentreIn>(condition)) return 0;
  return std::holds_alternative<Stays>(condition) ? 1 : 2;
}

}  // namespace

bool meets_terms_of(GoalDraw& draw, std::size_t body, const Poses& poses) {
  bool met = true;
  for (std::size_t k = 0; k < draw.goal.size(); ++k) {
    const GoalTerm& term = draw.goal[k];
    if (!is_of_one_body(term) || !concerns(term, draw.task.scene, body)) continue;
    if (excess(term, draw.task, poses, body) <= 0.0) continue;
    draw.refusals.count({Refusal::Kind::kTerm, k});
    met = false;
  }
  return met;
}

bool meets_goal(GoalDraw& draw) {
  draw.refusals = {};
  bool met = true;
  for (std::size_t k = 0; k < draw.goal.size(); ++k)
    if (!is_of_one_body(draw.goal[k]) && !holds(draw.goal[k], draw.task, draw.state.poses)) {
      draw.refusals.count({Refusal::Kind::kTerm, k});
      met = false;
    }
  return met;
}

Vector2d point_in_arena(GoalDraw& draw) {
  const double a = draw.task.push.arena;
  const double x = draw.rng.uniform(-a, a);
  return {x, draw.rng.uniform(-a, a)};
}

Pose pose_in_goal(GoalDraw& draw, std::size_t i) {
  const Vector2d x = point_in_arena(draw);
  Pose pose{x.x(), x.y(), 0.0};
  for (int turn = 0; turn < 3; ++turn) {
    if (turn == 1) pose.theta = draw.rng.uniform(-std::numbers::pi, std::numbers::pi);
    for (const GoalTerm& term : draw.goal)
      if (!term.negated && rank(term.condition) == turn && concerns(term, draw.task.scene, i))
        aim(term.condition, draw.task.start[i], draw.task.scene.bodies[i].shape, pose, draw.rng);
  }
  return pose;
}

}  // namespace rtg::tasks
