#include "nodes/config/task_checks.hpp"

#include <algorithm>
#include <numbers>
#include <string>

#include "core/tasks/goal_sampler.hpp"
#include "core/world/separation.hpp"
#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

constexpr int kDraws = 10;  // of goal states until a goal counts as one that cannot be met

const std::string kRobotKind = "robot";

std::string body_path(std::size_t i) { return "task.bodies." + std::to_string(i); }

const ConfigNode& body_section(const ConfigNode& section, std::size_t i) {
  return find(section, "bodies")->value.items[i];
}

[[noreturn]] void fail_at(const ConfigNode& section, std::size_t body, const char* key,
                          const std::string& wrong, const std::string& legal) {
  fail_at(body_section(section, body), body_path(body), key, wrong, legal);
}

void check_movable(const tasks::Task& task, const ConfigNode& section) {
  const auto& bodies = task.scene.bodies;
  if (bodies[0].fixed)
    fail_at(section, 0, "fixed",
            "is true, but the first body is the robot, which must be able to move", "false");
  if (std::all_of(bodies.begin() + 1, bodies.end(), [](const Body& body) { return body.fixed; }))
    fail_at(section, 1, "fixed", "is true for all objects, so that none can move",
            "false for at least one body other than the robot");
}

void check_start(const tasks::Task& task, const ConfigNode& section) {
  const std::string arena = length_text(task.push.arena, task.units);
  for (std::size_t i = 0; i < task.scene.size(); ++i) {
    const Body& body = task.scene.bodies[i];
    if (body.fixed) continue;
    if (!in_arena(task.start[i], task.push))
      fail_at(section, i, "start", "lies outside the arena",
              "x and y from -" + arena + " to " + arena + " m (task.push.arena)");
    if (body.shape.radius() > task.push.arena)
      fail_at(section, i, "shape", "is larger than the arena",
              "a bounding radius of at most " + arena + " m (task.push.arena)");
  }
  if (const auto pair = first_overlap(task.scene, task.start, tasks::kStartClearance)) {
    const auto [a, b] = std::minmax(pair->first, pair->second);
    const double gap = separation(task.scene.bodies[a].shape, task.start[a],
                                  task.scene.bodies[b].shape, task.start[b]);
    fail_at(section, b, "start",
            (gap < 0.0 ? "overlaps '" : "is too close to '") + task.scene.bodies[a].name + "'",
            "bodies at least " + length_text(tasks::kStartClearance, task.units) + " m apart");
  }
}

/// Adds the kinds of the objects i for which `counts`(i) to `kinds`, each once, and lists all.
template <class Counts>
std::string with_kinds(std::vector<std::string> kinds, const Scene& scene, Counts counts) {
  for (std::size_t i = 1; i < scene.size(); ++i)
    if (counts(i) && !std::ranges::count(kinds, scene.bodies[i].kind))
      kinds.push_back(scene.bodies[i].kind);
  return listed(kinds);
}

/// Lists "*" and the kinds of the objects that can move.
std::string legal_kinds(const Scene& scene) {
  return with_kinds({"\"*\""}, scene, [&](std::size_t i) { return !scene.bodies[i].fixed; });
}

/// Says what goals are about if `kind` is that of the robot.
std::string robot_hint(const std::string& kind, const Scene& scene) {
  return kind == scene.bodies[0].kind ? " (goals are about objects, not about the robot)" : "";
}

/// Returns whether an object beside object `i` is of kind `kind`, or can move if that is "*".
bool has_other(const Scene& scene, std::size_t i, const std::string& kind) {
  for (std::size_t j = 1; j < scene.size(); ++j)
    if (j != i && (kind == "*" ? !scene.bodies[j].fixed : scene.bodies[j].kind == kind))
      return true;
  return false;
}

/// Lists the kinds of the objects beside object `i`, and "*" if one of these can move.
std::string legal_others(const Scene& scene, std::size_t i) {
  const std::string kinds = with_kinds({}, scene, [i](std::size_t j) { return j != i; });
  if (kinds.empty()) return "none, because there is no other object";
  const bool any = has_other(scene, i, "*");
  return (any ? "\"*\" for all objects, or " : "") +
         ("the kind of another object, also fixed: " + kinds);
}

/// Returns whether some point at which `term` asks for a body lies in the arena, |x|, |y| ≤ a.
bool meets_arena(const tasks::GoalTerm& term, double a) {
  if (term.negated) return true;
  if (const auto* in = std::get_if<tasks::CentreIn>(&term.condition))
    return meets_square(in->region, a);
  if (const auto* mean = std::get_if<tasks::MeanIn>(&term.condition))
    return meets_square(mean->region, a);
  const auto inside = [a](const Pose& pose) { return pose.position().cwiseAbs().maxCoeff() <= a; };
  if (const auto* near = std::get_if<tasks::PoseNear>(&term.condition)) return inside(near->pose);
  if (const auto* covers = std::get_if<tasks::Covers>(&term.condition)) return inside(covers->pose);
  return true;
}

/// Lists "*" and the names of the children of joints of a type.
std::string legal_joints(const tasks::Task& task, JointType type) {
  std::vector<std::string> names{"\"*\""};
  for (const Joint& joint : task.scene.joints)
    if (joint.type == type)
      names.push_back(task.scene.bodies[static_cast<std::size_t>(joint.child)].name);
  return names.size() == 1 ? "none, because the task has no such joints" : listed(names);
}

bool concerns_something(const tasks::GoalTerm& term, const Scene& scene) {
  for (std::size_t i = 1; i < scene.size(); ++i)
    if (concerns(term, scene, i) && !scene.bodies[i].fixed) return true;
  return std::ranges::any_of(scene.joints,
                             [&](const Joint& joint) { return concerns(term, scene, joint); });
}

/// Throws ConfigError if the term concerns `joint` and cannot be met by it. The limits must allow
/// a value that meets the tightened() term. Angles must be less than a full turn apart.
void check_joint(const tasks::GoalTerm& term, const Joint& joint, const tasks::Task& task,
                 const ConfigEntry& range, const std::string& path) {
  if (!concerns(term, task.scene, joint)) return;
  const std::string& child = task.scene.bodies[static_cast<std::size_t>(joint.child)].name;
  const bool slides = joint.type == JointType::kPrismatic;
  if (!slides && !(joint.upper - joint.lower < 2.0 * std::numbers::pi))
    throw ConfigError(range.value.origin, path + ".joint",
                      "the joint of '" + child + "' can make a full turn",
                      "joints whose limits are less than 6.28 rad apart");
  const auto inner = std::get<tasks::JointIn>(tightened(term, task.scene).condition);
  if (term.negated ? joint.lower <= inner.least || joint.upper >= inner.most
                   : std::max(joint.lower, inner.least) <= std::min(joint.upper, inner.most))
    return;
  const auto text = [&](double value) {
    return slides ? length_text(value, task.units) : number_text(value);
  };
  const std::string unit = slides ? " m" : " rad", margin = text(tasks::kGoalSpare) + unit;
  const std::string limits = text(joint.lower) + " to " + text(joint.upper);
  throw ConfigError(
      range.value.origin, path + '.' + range.key,
      "the joint of '" + child +
          (term.negated ? "' cannot get out of this range"
                        : "' cannot get " + margin + " into this range"),
      "[least, most] in" + unit +
          (term.negated ? " that leaves a part of its limits, " + limits
                        : " that overlaps its limits, " + limits + ", by at least " + margin));
}

/// Throws ConfigError if a body that a term compares with others has none of their kind.
void check_other(const tasks::GoalTerm& term, const tasks::Task& task, const ConfigNode& node,
                 const std::string& path) {
  const auto check = [&](const std::string& kind, const char* key) {
    const Scene& scene = task.scene;
    for (std::size_t i = 1; i < scene.size(); ++i)
      if (concerns(term, scene, i) && !has_other(scene, i, kind))
        throw ConfigError(find(node, key)->value.origin, path + '.' + key,
                          kind == "*" ? "no object beside '" + scene.bodies[i].name + "' can move"
                                      : "no object beside '" + scene.bodies[i].name +
                                            "' is of kind '" + kind + "'" + robot_hint(kind, scene),
                          legal_others(scene, i));
  };
  if (const auto* touches = std::get_if<tasks::Touches>(&term.condition))
    check(touches->other, "touching");
  if (const auto* apart = std::get_if<tasks::KeepsFrom>(&term.condition))
    check(apart->other, "apart");
}

/// Throws ConfigError if a body that is to stay has no place of its own.
void check_stays(const tasks::GoalTerm& term, const tasks::Task& task, const ConfigNode& node,
                 const std::string& path) {
  if (!std::holds_alternative<tasks::Stays>(term.condition)) return;
  for (std::size_t i = 1; i < task.start_ranges.size(); ++i)
    if (task.start_range(i) && concerns(term, task.scene, i))
      throw ConfigError(find(node, "stays")->value.origin, path + ".stays",
                        '\'' + task.scene.bodies[i].name + "' starts anywhere in a range",
                        "bodies whose start is [x, y, theta]");
}

/// Throws ConfigError if a body that an angle term concerns meets it at any angle.
void check_angle(const tasks::GoalTerm& term, const tasks::Task& task, const ConfigNode& node,
                 const std::string& path) {
  const auto* range = std::get_if<tasks::AngleIn>(&term.condition);
  for (std::size_t i = 1; range && i < task.scene.size(); ++i) {
    const double period = task.scene.bodies[i].shape.symmetry();
    if (!concerns(term, task.scene, i) || range->most - range->least < period) continue;
    throw ConfigError(find(node, "angle")->value.origin, path + ".angle",
                      "holds at any angle of '" + task.scene.bodies[i].name + "'",
                      period == 0.0 ? "bodies that are no discs"
                                    : "a range narrower than " + number_text(period) +
                                          " rad, by which the body can be turned onto itself");
  }
}

void check_term(const tasks::Task& task, std::size_t k, const ConfigNode& section) {
  const tasks::GoalTerm& term = task.goal[k];
  const ConfigNode& node = find(section, "goal")->value.items[k];
  const std::string path = "task.goal." + std::to_string(k);
  if (!concerns_something(term, task.scene)) {
    const auto* of_joint = std::get_if<tasks::JointIn>(&term.condition);
    const char* key = of_joint ? "joint" : find(node, "centroid") ? "centroid" : "kind";
    const ConfigEntry* subject = find(node, key);
    throw ConfigError(
        subject ? subject->value.origin : node.origin, path + '.' + key,
        of_joint ? (of_joint->type == JointType::kPrismatic ? "no prismatic joint has the child '"
                                                            : "no revolute joint has the child '") +
                       term.kind + "'"
                 : "no object that can move is of kind '" + term.kind + "'" +
                       robot_hint(term.kind, task.scene),
        of_joint ? legal_joints(task, of_joint->type) : legal_kinds(task.scene));
  }
  check_other(term, task, node, path);
  check_stays(term, task, node, path);
  check_angle(term, task, node, path);
  for (const char* key : {"angles", "slides"})
    if (const ConfigEntry* range = find(node, key))
      for (const Joint& joint : task.scene.joints) check_joint(term, joint, task, *range, path);
  const std::string arena = length_text(task.push.arena, task.units);
  if (!meets_arena(term, task.push.arena))
    throw ConfigError(node.origin, path, "lies outside the arena",
                      "a region that contains a point with x and y from -" + arena + " to " +
                          arena + " m (task.push.arena)");
}

/// Returns whether fixed body `body` meets all goal terms that concern it.
bool stands_right(const tasks::Task& task, std::size_t body) {
  return std::ranges::all_of(task.goal, [&](const tasks::GoalTerm& term) {
    return !is_of_one_body(term) || !concerns(term, task.scene, body) ||
           excess(term, task, task.start, body) <= 0.0;
  });
}

void check_goal(const tasks::Task& task, const ConfigNode& section) {
  const std::string& origin = find(section, "goal")->value.origin;
  for (std::size_t i = 1; i < task.scene.size(); ++i)
    if (task.scene.bodies[i].fixed && !stands_right(task, i))
      throw ConfigError(origin, "task.goal",
                        "does not hold for the fixed body '" + task.scene.bodies[i].name + "'",
                        "terms that hold for all fixed bodies of their kind");
  if (succeeded(task, task.start))
    throw ConfigError(origin, "task.goal", "holds in the start state",
                      "a goal that the start state does not meet");
  Rng rng(1);
  tasks::Refusals refusals;
  for (int draw = 0; draw < kDraws; ++draw)
    if (sample_goal(task, rng, &refusals)) return;
  const auto term = main_term(refusals);
  throw ConfigError(
      term ? find(section, "goal")->value.items[*term].origin : origin, "task.goal",
      "no layout of the bodies that meets the goal was found in " + std::to_string(kDraws) +
          " draws; " + main_reason(refusals, task.scene),
      "terms that all objects can meet at once, with a margin of " +
          length_text(tasks::kGoalSpare, task.units) +
          " m and 0.05 rad; objects that fit only side by side need a term on their angle, too");
}

}  // namespace

void check_names(const tasks::Task& task, const ConfigNode& section) {
  const auto& bodies = task.scene.bodies;
  for (std::size_t i = 1; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (bodies[i].name == bodies[j].name)
        fail_at(section, i, "name",
                "'" + bodies[i].name + "' is already the name of body " + std::to_string(j),
                "a name that no other body has");
  for (std::size_t i = 1; i < bodies.size(); ++i)
    if (bodies[i].kind == kRobotKind && bodies[0].kind != kRobotKind)
      fail_at(section, i, "kind",
              "is robot, but the first body is the robot, '" + bodies[0].name + "' of kind '" +
                  bodies[0].kind + "'",
              "the body of kind robot as the first one, or another kind");
}

void check_terms(const tasks::Task& task, const ConfigNode& section) {
  check_movable(task, section);
  for (std::size_t k = 0; k < task.goal.size(); ++k) check_term(task, k, section);
}

void check_task(const tasks::Task& task, const ConfigNode& section) {
  check_start(task, section);
  check_goal(task, section);
}

}  // namespace rtg::config
