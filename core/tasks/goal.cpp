#include "core/tasks/goal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/tasks/goal_atoms.hpp"
#include "core/world/overlap.hpp"
#include "core/world/separation.hpp"

namespace rtg::tasks {
namespace {

/// Helper to visit a variant by lambdas.
template <class... F>
struct Cases : F... {
  using F::operator()...;
};

double turn_between(double a, double b, double period) {
  return period > 0.0 ? std::abs(std::remainder(a - b, period)) : 0.0;
}

/// Returns the separation of `body` from the nearest other body of `kind` [m]; infinite without
/// one.
double nearest(const Scene& scene, const Poses& poses, std::size_t body, const std::string& kind) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 1; j < poses.size(); ++j) {
    const Body& other = scene.bodies[j];
    if (j == body || (kind == "*" ? other.fixed : other.kind != kind)) continue;
    least =
        std::min(least, separation(scene.bodies[body].shape, poses[body], other.shape, poses[j]));
  }
  return least;
}

double excess_of(const CentreIn& c, const Task&, const Poses& poses, std::size_t body) {
  return excess(c.region, poses[body].position());
}

double excess_of(const AngleIn& c, const Task& task, const Poses& poses, std::size_t body) {
  const double period = task.scene.bodies[body].shape.symmetry();
  return turn_between(poses[body].theta, (c.least + c.most) / 2.0, period) -
         (c.most - c.least) / 2.0;
}

double excess_of(const PoseNear& c, const Task& task, const Poses& poses, std::size_t body) {
  const double way = (poses[body].position() - c.pose.position()).norm() - c.distance;
  const double turn =
      turn_between(poses[body].theta, c.pose.theta, task.scene.bodies[body].shape.symmetry()) -
      c.turn;
  const double missing = std::max(way, 0.0) + std::max(turn, 0.0);
  return missing > 0.0 ? missing : std::max(way, turn);
}

/// The missing share times the bounding radius [m]; where nothing is covered the way to there comes
/// on top.
double excess_of(const Covers& c, const Task& task, const Poses& poses, std::size_t body) {
  const Shape& shape = task.scene.bodies[body].shape;
  const double share = covered_share(shape, poses[body], c.pose);
  const double missing = (c.share - share) * shape.radius();
  const double way = (poses[body].position() - c.pose.position()).norm();
  return share > 0.0 ? missing : missing + std::max(0.0, way - shape.radius());
}

double excess_of(const Touches& c, const Task& task, const Poses& poses, std::size_t body) {
  return nearest(task.scene, poses, body, c.other) - c.gap;
}

double excess_of(const KeepsFrom& c, const Task& task, const Poses& poses, std::size_t body) {
  return c.gap - nearest(task.scene, poses, body, c.other);
}

double excess_of(const Stays& c, const Task& task, const Poses& poses, std::size_t body) {
  return (poses[body].position() - task.start[body].position()).norm() - c.distance;
}

/// JointIn and MeanIn, which are not about bodies one by one.
template <class Other>
double excess_of(const Other&, const Task&, const Poses&, std::size_t) {
  return 0.0;
}

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

/// Returns the margin by which a sampled state meets a condition that allows `room`.
double spare(double room) { return std::min(kGoalSpare, 0.2 * room); }

/// Returns the least angle by which a body that `term` concerns can be turned onto itself [rad].
double least_symmetry(const GoalTerm& term, const Scene& scene) {
  double least = 2.0 * std::numbers::pi;
  for (std::size_t i = 1; i < scene.size(); ++i)
    if (const double own = scene.bodies[i].shape.symmetry(); concerns(term, scene, i) && own > 0.0)
      least = std::min(least, own);
  return least;
}

void tighten(Region& region, double sign) {
  region = inset(region, sign * spare(half_width(region)));
}

/// `around`: all angles, of which a negated term leaves those outside of the range.
void tighten_range(double& least, double& most, double sign, double around) {
  const double width = most - least;
  const double by = sign * spare((sign > 0.0 ? width : around - width) / 2.0);
  least += by;
  most -= by;
}

/// A negated term leaves what the limits allow on either side of the range.
void tighten(JointIn& range, const GoalTerm& term, const Scene& scene) {
  if (!term.negated) {
    tighten_range(range.least, range.most, 1.0, 0.0);
    return;
  }
  double below = kAnywhere, above = kAnywhere;
  for (const Joint& joint : scene.joints) {
    if (!concerns(term, scene, joint)) continue;
    if (joint.lower < range.least) below = std::min(below, range.least - joint.lower);
    if (joint.upper > range.most) above = std::min(above, joint.upper - range.most);
  }
  range.least -= spare(below);
  range.most += spare(above);
}

}  // namespace

bool concerns(const GoalTerm& term, const Scene& scene, std::size_t body) {
  if (body == 0 || std::holds_alternative<JointIn>(term.condition)) return false;
  const Body& one = scene.bodies[body];
  return term.kind == "*" ? !one.fixed : term.kind == one.kind;
}

bool concerns(const GoalTerm& term, const Scene& scene, const Joint& joint) {
  const auto* range = std::get_if<JointIn>(&term.condition);
  if (!range || joint.type != range->type) return false;
  return term.kind == "*" || term.kind == scene.bodies[static_cast<std::size_t>(joint.child)].name;
}

bool is_of_one_body(const GoalTerm& term) {
  return std::visit(Cases{[](const MeanIn&) { return false; }, [](const JointIn&) { return false; },
                          [](const Touches&) { return false; },
                          [](const KeepsFrom&) { return false; }, [](const auto&) { return true; }},
                    term.condition);
}

double excess(const GoalTerm& term, const Task& task, const Poses& poses, std::size_t body) {
  const double off =
      std::visit([&](const auto& c) { return excess_of(c, task, poses, body); }, term.condition);
  return term.negated ? -off : off;
}

double excess(const GoalTerm& term, const Joint& joint, const Poses& poses) {
  const auto& [least, most, type] = std::get<JointIn>(term.condition);
  const double value = joint_value(joint, poses);
  const double off = std::max(least - value, value - most);
  return term.negated ? -off : off;
}

Vector2d centroid_of(const GoalTerm& term, const Scene& scene, const Poses& poses) {
  Vector2d sum = Vector2d::Zero();
  double count = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!concerns(term, scene, i)) continue;
    sum += poses[i].position();
    count += 1.0;
  }
  return sum / count;
}

bool holds(const GoalTerm& term, const Task& task, const Poses& poses) {
  bool all = true;
  for_each_atom(term, task, poses, [&all](const Atom& atom) { all = all && atom.excess <= 0.0; });
  return all;
}

GoalTerm tightened(const GoalTerm& term, const Scene& scene) {
  GoalTerm out = term;
  const double sign = term.negated ? -1.0 : 1.0;
  std::visit(
      Cases{[&](CentreIn& c) { tighten(c.region, sign); },
            [&](MeanIn& c) { tighten(c.region, sign); },
            [&](AngleIn& c) { tighten_range(c.least, c.most, sign, least_symmetry(term, scene)); },
            [&](PoseNear& c) {
              c.distance -= sign * spare(c.distance);
              c.turn -= sign * spare(c.turn);
            },
            [&](Covers& c) { c.share += sign * spare(1.0 - c.share); },
            [&](Touches& c) { c.gap -= sign * spare(c.gap); },
            [&](KeepsFrom& c) { c.gap += term.negated ? -spare(c.gap) : kGoalSpare; },
            [&](Stays& c) { c.distance -= sign * spare(c.distance); },
            [&](JointIn& c) { tighten(c, term, scene); }},
      out.condition);
  return out;
}

}  // namespace rtg::tasks
