#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/math/draws.hpp"
#include "core/tasks/placement.hpp"
#include "core/tasks/task.hpp"
#include "core/world/separation.hpp"

namespace rtg::tasks {
namespace {

constexpr int kAttempts = 1000;
constexpr int kProposals = 50;        // tries to place a body (or a tree of joints) in one attempt
constexpr double kBesideShare = 0.5;  // share of proposals that put a body beside another one
constexpr double kFaceShare = 0.8;    // share of those that lie face to face with it then
constexpr double kSlideError = 1e-3;  // largest error of that gap [m]
constexpr double kTouchingShare = 0.9;  // the same if the goal asks for that
constexpr double kBesideGap = 0.1;      // largest gap to that body [m]
constexpr double kBehindShare = 0.75;   // probability that the robot stands as after a push
constexpr double kBehindGap = 0.03;     // robot as after a push: largest gap above kClearance [m]
constexpr double kFreeRange = 3.0;      // otherwise: largest offset from a body in x and in y [m]
constexpr double kTwoPi = 2.0 * std::numbers::pi;

Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

Vector2d point_in_arena(const Task& task, Rng& rng) {
  const double a = task.push.arena;
  const double x = rng.uniform(-a, a);
  return {x, rng.uniform(-a, a)};
}

/// What is being sampled, with the goal as it is to hold: tightened().
struct Draw {
  const Task& task;
  const std::vector<GoalTerm>& goal;
  Rng& rng;
  GoalRefusals& refusals;
  PartialState state;

  /// Returns whether a body meets the terms on it alone; counts the term that fails.
  bool meets_terms_of(std::size_t body, const Poses& poses) {
    for (std::size_t k = 0; k < goal.size(); ++k) {
      if (!is_of_one_body(goal[k]) || !concerns(goal[k], task.scene, body)) continue;
      if (excess(goal[k], task, poses, body) <= 0.0) continue;
      ++refusals.by_term[k];
      return false;
    }
    return true;
  }
};

double drawn_angle(const AngleIn& range, double period, Rng& rng) {
  const double angle = rng.uniform(range.least, range.most);
  if (period == 0.0) return rng.uniform(-std::numbers::pi, std::numbers::pi);
  const auto turns = static_cast<int>(std::lround(kTwoPi / period));
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

/// Draws a pose of body `i` for the goal: a uniform point of the arena, moved into the regions for
/// the centre, and any angle; then what the other terms on the body ask for, one after another.
Pose pose_in_goal(Draw& draw, std::size_t i) {
  const Vector2d x = point_in_arena(draw.task, draw.rng);
  Pose pose{x.x(), x.y(), 0.0};
  for (int turn = 0; turn < 3; ++turn) {
    if (turn == 1) pose.theta = draw.rng.uniform(-std::numbers::pi, std::numbers::pi);
    for (const GoalTerm& term : draw.goal)
      if (!term.negated && rank(term.condition) == turn && concerns(term, draw.task.scene, i))
        aim(term.condition, draw.task.start[i], draw.task.scene.bodies[i].shape, pose, draw.rng);
  }
  return pose;
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

/// Proposes a pose of body `i` beside body `j`, which is placed. Body `i` slides towards that body
/// from a random side, face to face with the probability `face_share`, else at a random angle.
/// Returns nothing if slide() fails.
std::optional<Pose> beside(const Task& task, const PartialState& state, std::size_t i,
                           std::size_t j, double face_share, Rng& rng) {
  const Shape &mine = task.scene.bodies[i].shape, &other = task.scene.bodies[j].shape;
  const std::vector<double> ours = normal_angles(mine), theirs = normal_angles(other);
  double side = rng.uniform(0.0, kTwoPi), theta = rng.uniform(-std::numbers::pi, std::numbers::pi);
  if (rng.uniform(0.0, 1.0) < face_share && !ours.empty() && !theirs.empty()) {
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

/// Proposes a pose of body `i` beside a random other body. Returns nothing if that is not placed.
std::optional<Pose> beside_any(const Task& task, const PartialState& state, std::size_t i,
                               Rng& rng) {
  const auto j = static_cast<std::size_t>(1 + rng.below(static_cast<int>(task.scene.size()) - 1));
  if (j == i || !state.placed[j]) return std::nullopt;
  return beside(task, state, i, j, 0.5, rng);
}

/// Returns the placed bodies that a term asks body `i` to touch, in random order.
std::vector<std::size_t> to_touch(Draw& draw, std::size_t i) {
  std::vector<std::size_t> found;
  for (const GoalTerm& term : draw.goal) {
    const auto* touches = std::get_if<Touches>(&term.condition);
    if (!touches || term.negated || !concerns(term, draw.task.scene, i)) continue;
    for (std::size_t j = 1; j < draw.state.poses.size(); ++j) {
      const Body& other = draw.task.scene.bodies[j];
      if (j == i || !draw.state.placed[j]) continue;
      if (touches->other == "*" ? !other.fixed : touches->other == other.kind) found.push_back(j);
    }
  }
  return drawn(found, static_cast<int>(found.size()), draw.rng);
}

/// Moves a pose of body `i` straight along `heading` until the body is kBesideGap / 2 from body
/// `k`.
Pose moved_up_to(const Draw& draw, std::size_t i, Pose pose, const Vector2d& heading,
                 std::size_t k) {
  const Shape &mine = draw.task.scene.bodies[i].shape, &other = draw.task.scene.bodies[k].shape;
  for (int step = 0; step < kProposals; ++step) {
    const double free = separation(mine, pose, other, draw.state.poses[k]) - kBesideGap / 2.0;
    if (free < kSlideError) break;
    pose.x += free * heading.x();
    pose.y += free * heading.y();
  }
  return pose;
}

/// Proposes a pose of body `i` at one of the bodies that it is to touch, and of two if there are
/// more: beside the first it then moves along until it meets the second.
std::optional<Pose> in_touch(Draw& draw, std::size_t i) {
  const std::vector<std::size_t> others = to_touch(draw, i);
  if (others.empty()) return std::nullopt;
  const std::optional<Pose> pose =
      beside(draw.task, draw.state, i, others[0], kFaceShare, draw.rng);
  if (!pose || others.size() == 1 || draw.rng.uniform(0.0, 1.0) < 0.2) return pose;
  const Vector2d to = draw.state.poses[others[1]].position() - pose->position();
  const double turn =
      pose->theta +
      std::round((std::atan2(to.y(), to.x()) - pose->theta) / (kTwoPi / 4.0)) * (kTwoPi / 4.0);
  return moved_up_to(draw, i, *pose, unit(turn), others[1]);
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

/// Returns whether the position of `group` decides if `term`, which has the condition MeanIn,
/// holds. It does if `term` applies to a body of the group and all its other bodies are placed
/// already.
bool determines_mean(const Group& group, const GoalTerm& term, const Draw& draw) {
  const auto concerned = [&](std::size_t i) { return concerns(term, draw.task.scene, i); };
  for (std::size_t i = 1; i < draw.task.scene.size(); ++i)
    if (concerned(i) && !draw.state.placed[i] && !std::ranges::count(group.members, i))
      return false;
  return std::ranges::any_of(group.members, concerned);
}

/// For each term whose mean the group determines (determines_mean()), moves the group so that the
/// mean centre lies in the region.
void aim_at_means(Draw& draw, Group& group) {
  const Scene& scene = draw.task.scene;
  for (const GoalTerm& term : draw.goal) {
    const auto* mean = std::get_if<MeanIn>(&term.condition);
    if (!mean || term.negated || !determines_mean(group, term, draw)) continue;
    const auto concerned = [&](std::size_t i) { return concerns(term, scene, i); };
    std::size_t all = 0;
    for (std::size_t i = 1; i < scene.size(); ++i) all += concerned(i);
    const auto ours = static_cast<double>(std::ranges::count_if(group.members, concerned));
    const Vector2d by = moved_into(mean->region, point_in_arena(draw.task, draw.rng), draw.rng) -
                        centroid_of(term, scene, group.poses);
    move(group, static_cast<double>(all) / ours * by);
  }
}

/// Adds the bodies of `group` to the state if their poses are legal; returns whether they are. Each
/// movable body must meet the terms on it alone and lie in the arena. It must be clear of the
/// bodies placed before and of the rest of the group.
bool try_add(Draw& draw, const Group& group) {
  PartialState trial = draw.state;
  for (const std::size_t i : group.members) {
    const Pose& pose = group.poses[i];
    if (!draw.task.scene.bodies[i].fixed) {
      if (!draw.meets_terms_of(i, group.poses)) return false;
      const bool within = in_arena(pose, draw.task.push);
      if (const auto other = within ? blocker(draw.task, trial, i, pose) : std::nullopt;
          other || !within) {
        ++draw.refusals.no_room[{i, other.value_or(i)}];
        return false;
      }
    }
    trial.poses[i] = pose;
    trial.placed[i] = true;
  }
  draw.state = std::move(trial);
  return true;
}

/// Returns the probability with which a body is proposed beside another one: 0 if a term says where
/// it is to lie, more than usual if a term says that it is to touch.
double beside_share(const Draw& draw, std::size_t i) {
  double share = kBesideShare;
  for (const GoalTerm& term : draw.goal) {
    if (term.negated || !concerns(term, draw.task.scene, i)) continue;
    if (std::holds_alternative<Touches>(term.condition)) share = kTouchingShare;
    if (std::holds_alternative<PoseNear>(term.condition) ||
        std::holds_alternative<Covers>(term.condition))
      return 0.0;
  }
  return share;
}

bool place_object(Draw& draw, std::size_t i) {
  const double share = beside_share(draw, i);
  for (int k = 0; k < kProposals; ++k) {
    Group group{i, {i}, draw.state.poses};
    if (draw.rng.uniform(0.0, 1.0) < share) {
      std::optional<Pose> pose = in_touch(draw, i);
      if (!pose) pose = beside_any(draw.task, draw.state, i, draw.rng);
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

/// Returns the least and the largest value that the limits of `joint` and the goal allow. Returns
/// nothing if there is no such value, and counts the term that leaves none.
std::optional<std::pair<double, double>> values_in_goal(Draw& draw, const Joint& joint) {
  const double span =
      joint.type == JointType::kPrismatic ? 2.0 * draw.task.push.arena : std::numbers::pi;
  double least = std::isfinite(joint.lower) ? joint.lower : -span;
  double most = std::isfinite(joint.upper) ? joint.upper : span;
  for (std::size_t k = 0; k < draw.goal.size(); ++k) {
    const GoalTerm& term = draw.goal[k];
    if (term.negated || !concerns(term, draw.task.scene, joint)) continue;
    const auto& range = std::get<JointIn>(term.condition);
    least = std::max(least, range.least);
    most = std::min(most, range.most);
    if (least > most) {
      ++draw.refusals.by_term[k];
      return std::nullopt;
    }
  }
  return std::pair{least, most};
}

/// Returns the member by whose pose place_tree() positions the group: the first that has a term of
/// its own, otherwise the root.
std::size_t positioned_member(const Draw& draw, const Group& group) {
  for (const std::size_t i : group.members)
    for (const GoalTerm& term : draw.goal)
      if (is_of_one_body(term) && concerns(term, draw.task.scene, i)) return i;
  return group.root;
}

/// Gives each joint of the group a random value that its limits and the goal allow. Returns false
/// if a joint has no such value.
bool draw_joint_values(Draw& draw, Group& group) {
  const Scene& scene = draw.task.scene;
  for (const std::size_t n : root_first(scene)) {
    const Joint& joint = scene.joints[n];
    const auto child = static_cast<std::size_t>(joint.child);
    if (!std::ranges::count(group.members, child)) continue;
    const auto values = values_in_goal(draw, joint);
    if (!values) return false;
    set_joint_value(joint, draw.rng.uniform(values->first, values->second), group.poses);
  }
  return true;
}

/// Turns and moves the group as a rigid body until `member` has the pose `to`.
void move_to(Group& group, std::size_t member, const Pose& to) {
  const Pose from = group.poses[member];
  for (const std::size_t i : group.members) group.poses[i] = carried(group.poses[i], from, to);
}

/// Places a tree of jointed bodies: draws the values of its joints, then moves the tree to where
/// the goal asks for one of its members. A fixed root stays. Returns whether one of kProposals
/// tries succeeded.
bool place_tree(Draw& draw, const Group& tree) {
  for (int k = 0; k < kProposals; ++k) {
    Group group = tree;
    if (!draw_joint_values(draw, group)) return false;
    if (!draw.task.scene.bodies[group.root].fixed) {
      const std::size_t positioned = positioned_member(draw, group);
      move_to(group, positioned, pose_in_goal(draw, positioned));
      aim_at_means(draw, group);
    }
    if (try_add(draw, group)) return true;
  }
  return false;
}

/// Draws a pose of the robot as after a push: it slides along a random heading towards a random
/// body until it meets a body. Returns nothing if it meets none.
std::optional<Pose> robot_behind(const Task& task, const PartialState& state, Rng& rng) {
  const auto j = static_cast<std::size_t>(1 + rng.below(static_cast<int>(task.scene.size()) - 1));
  const Vector2d d = direction(rng.below(task.push.headings), task.push);
  const double span = task.scene.bodies[0].shape.radius() + task.scene.bodies[j].shape.radius();
  const Vector2d from = state.poses[j].position() - (span + longest_stride(task.push)) * d +
                        rng.uniform(-0.8, 0.8) * span * Vector2d(-d.y(), d.x());
  return slide(task, state, 0,
               {.from = {from.x(), from.y(), task.start[0].theta},
                .heading = d,
                .gap = kClearance + rng.uniform(0.0, kBehindGap),
                .range = 2.0 * (span + longest_stride(task.push))});
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

bool place_objects(Draw& draw) {
  const Scene& scene = draw.task.scene;
  const std::vector<std::size_t> roots = roots_of(scene);
  for (std::size_t i = 1; i < scene.size(); ++i) {
    if (roots[i] != i) continue;
    Group group{i, {}, draw.state.poses};
    for (std::size_t j = 1; j < scene.size(); ++j)
      if (roots[j] == i) group.members.push_back(j);
    const bool alone = group.members.size() == 1;
    if (alone && scene.bodies[i].fixed) continue;
    if (alone ? !place_object(draw, i) : !place_tree(draw, group)) return false;
  }
  return true;
}

/// Returns whether all terms hold; counts one that does not.
bool meets_goal(Draw& draw) {
  for (std::size_t k = 0; k < draw.goal.size(); ++k)
    if (!is_of_one_body(draw.goal[k]) && !holds(draw.goal[k], draw.task, draw.state.poses)) {
      ++draw.refusals.by_term[k];
      return false;
    }
  return true;
}

std::optional<Poses> attempt(const Task& task, const std::vector<GoalTerm>& goal, Rng& rng,
                             GoalRefusals& refusals) {
  Draw draw{task, goal, rng, refusals, {task.start, std::vector<bool>(task.scene.size(), false)}};
  for (std::size_t i = 1; i < task.scene.size(); ++i)
    draw.state.placed[i] = task.scene.bodies[i].fixed;
  if (!place_objects(draw)) return std::nullopt;
  if (task.scene.size() > 1 && !place_robot(task, draw.state, rng)) {
    ++refusals.no_robot;
    return std::nullopt;
  }
  if (!meets_goal(draw)) return std::nullopt;
  return to_single(std::move(draw.state.poses));
}

/// Returns the number of all refusals.
long all_of(const GoalRefusals& refusals) {
  long all = refusals.no_robot;
  for (const long count : refusals.by_term) all += count;
  for (const auto& [bodies, count] : refusals.no_room) all += count;
  return all;
}

}  // namespace

std::optional<std::size_t> main_term(const GoalRefusals& refusals) {
  const auto most = std::ranges::max_element(refusals.by_term);
  if (most == refusals.by_term.end() || 2 * *most < all_of(refusals)) return std::nullopt;
  return most - refusals.by_term.begin();
}

std::string main_reason(const GoalRefusals& refusals, const Scene& scene) {
  const auto name = [&](std::size_t i) { return '\'' + scene.bodies[i].name + '\''; };
  std::vector<std::pair<long, std::string>> reasons{
      {refusals.no_robot, "the robot found no place"}};
  for (const auto& [bodies, count] : refusals.no_room)
    reasons.emplace_back(count, bodies.first == bodies.second
                                    ? name(bodies.first) + " left the arena"
                                    : name(bodies.first) + " overlapped " + name(bodies.second));
  for (std::size_t k = 0; k < refusals.by_term.size(); ++k)
    reasons.emplace_back(refusals.by_term[k], "task.goal." + std::to_string(k) + " did not hold");
  const auto& [count, words] = *std::ranges::max_element(reasons);
  const long share = 100 * count / std::max(all_of(refusals), 1L);
  return words + " in " + std::to_string(share) + "% of the tries";
}

std::optional<Poses> sample_goal(const Task& task, Rng& rng, GoalRefusals* refusals) {
  std::vector<GoalTerm> goal;
  for (const GoalTerm& term : task.goal) goal.push_back(tightened(term, task.scene));
  GoalRefusals own;
  GoalRefusals& counts = refusals ? *refusals : own;
  counts.by_term.resize(goal.size());
  for (int k = 0; k < kAttempts; ++k)
    if (std::optional<Poses> poses = attempt(task, goal, rng, counts)) return poses;
  return std::nullopt;
}

}  // namespace rtg::tasks
