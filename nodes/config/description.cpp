#include "nodes/config/description.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "core/world/pace.hpp"
#include "core/world/separation.hpp"

namespace rtg::config {
namespace {

[[gnu::format(printf, 1, 2)]] std::string print(const char* format, ...) {
  char line[400];
  va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  return line;
}

/// Rounded to 0.001, as 0 may not be exact, and without the sign of -0.
double degrees(double angle) { return std::round(angle * 180e3 / std::numbers::pi) / 1e3 + 0.0; }

/// Returns width and height of the axis-aligned bounding box of `shape` at angle 0 [m].
Vector2d extent(const Shape& shape) {
  Eigen::AlignedBox2d box;
  for (const auto& [core, radius] : shape.parts())
    for (const Vector2d& v : core.vertices)
      for (const double r : {-radius, radius}) box.extend(v + Vector2d::Constant(r));
  return box.sizes();
}

std::string shape_in_words(const Shape& shape, double metre) {
  const std::vector<Part>& parts = shape.parts();
  if (parts.size() == 1 && parts[0].is_disc())
    return print("disc, radius %.3g m", metre * shape.radius());
  const Vector2d size = metre * extent(shape);
  std::string form = print("%zu corners", parts[0].core.size());
  if (parts[0].radius > 0.0) form = print("%zu round corners", parts[0].core.size());
  if (parts.size() > 1) form = print("%zu convex parts", parts.size());
  return form + print(", %.3g x %.3g m", size.x(), size.y());
}

std::string half_plane_in_words(const Vector2d& normal, double offset) {
  if (normal.y() == 0.0)
    return print("x %s %.4g m", normal.x() > 0.0 ? "<=" : ">=", offset * normal.x() + 0.0);
  if (normal.x() == 0.0)
    return print("y %s %.4g m", normal.y() > 0.0 ? "<=" : ">=", offset * normal.y() + 0.0);
  return print("%.4g x %+.4g y <= %.4g m", normal.x(), normal.y(), offset);
}

std::string angles_in_words(double least, double most) {
  return print("from %.4g to %.4g deg", degrees(least), degrees(most));
}

std::string lengths_in_words(double least, double most) {
  return print("from %.4g to %.4g m", least, most);
}

/// Returns the box that a polygon with sides along the axes is; nothing of other polygons.
std::optional<Eigen::AlignedBox2d> as_upright_box(const Polygon& polygon) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& v : polygon.vertices) box.extend(v);
  const double area = area_integrals(polygon.vertices).area;
  if (area < (1.0 - 1e-9) * box.volume()) return std::nullopt;
  return box;
}

/// Says between which values a coordinate lies. A range of a start that is one number is 1e-6 wide.
std::string side_in_words(char axis, double least, double most, double metre) {
  if (most - least < 1e-5) return print("%c = %.4g m", axis, metre * (least + most) / 2.0 + 0.0);
  return print("%c ", axis) + lengths_in_words(metre * least, metre * most);
}

std::string region_in_words(const tasks::Region& region, double metre) {
  if (const auto* disc = std::get_if<tasks::Disc>(&region))
    return print("within %.4g m of (%.4g, %.4g)", metre * disc->radius, metre * disc->centre.x(),
                 metre * disc->centre.y());
  if (const auto* half = std::get_if<tasks::HalfPlane>(&region))
    return "at " + half_plane_in_words(half->normal, metre * half->offset);
  const Polygon& polygon = std::get<Polygon>(region);
  if (const auto box = as_upright_box(polygon))
    return "at " + side_in_words('x', box->min().x(), box->max().x(), metre) + ", " +
           side_in_words('y', box->min().y(), box->max().y(), metre);
  std::string out = "in the polygon";
  for (const Vector2d& v : polygon.vertices)
    out += print(" (%.4g, %.4g)", metre * v.x(), metre * v.y());
  return out;
}

std::string range_in_words(const tasks::StartRange& range, double metre) {
  std::string angles = angles_in_words(range.least, range.most);
  if (range.most - range.least > 2.0 * std::numbers::pi - 1e-3) angles = "any angle";
  if (range.most == range.least) angles = print("%.4g deg", degrees(range.least));
  return region_in_words(range.region, metre) + ", " + angles;
}

std::string start_in_words(const tasks::Task& task, std::size_t i) {
  const double metre = task.units.length;
  if (const tasks::StartRange* range = task.start_range(i)) return range_in_words(*range, metre);
  const Pose& start = task.start[i];
  return print("at (%.3g, %.3g), %.4g deg", metre * start.x, metre * start.y, degrees(start.theta));
}

std::string body_line(const tasks::Task& task, std::size_t i, std::size_t width) {
  const Body& body = task.scene.bodies[i];
  const double metre = task.units.length,
               mass = mass_of(body).mass * task.units.density * metre * metre;
  const std::string weight = body.fixed ? "fixed" : print("%.3g kg", mass);
  return print("  %-*s  %-8s  %s  %9s  friction %.2f  %s\n", static_cast<int>(width),
               body.name.c_str(), body.kind.c_str(), shape_in_words(body.shape, metre).c_str(),
               weight.c_str(), body.friction, start_in_words(task, i).c_str());
}

std::string bodies_in_words(const tasks::Task& task) {
  std::size_t width = 0;
  for (const Body& body : task.scene.bodies) width = std::max(width, body.name.size());
  std::string out = "bodies, the first is the robot\n";
  for (std::size_t i = 0; i < task.scene.size(); ++i) out += body_line(task, i, width);
  return out;
}

std::string heavy_in_words(const Config& config) {
  std::string out;
  for (const std::string& words : heavy_bodies(config))
    out += "  a push moves " + words +
           ": its mass is large for a robot of this density (task.bodies.0.density)\n";
  return out;
}

std::string joint_line(const Joint& joint, const tasks::Task& task) {
  const auto name = [&task](int body) {
    return task.scene.bodies[static_cast<std::size_t>(body)].name;
  };
  const std::string ends = "  '" + name(joint.child) + "' on '" + name(joint.parent) + "', ";
  if (joint.type == JointType::kFixed) return ends + "fixed\n";
  const bool limited = std::isfinite(joint.lower);
  if (joint.type == JointType::kRevolute)
    return ends + (limited ? angles_in_words(joint.lower, joint.upper) : "any angle") + '\n';
  const double metre = task.units.length;
  return ends + print("slides along (%.4g, %.4g)", joint.axis.x(), joint.axis.y()) +
         (limited ? ' ' + lengths_in_words(metre * joint.lower, metre * joint.upper) : "") + '\n';
}

std::string joints_in_words(const tasks::Task& task) {
  if (task.scene.joints.empty()) return "";
  std::string out = "joints\n";
  for (const Joint& joint : task.scene.joints) out += joint_line(joint, task);
  return out;
}

std::string pose_in_words(const Pose& pose, double metre) {
  return print("(%.4g, %.4g) at %.4g deg", metre * pose.x, metre * pose.y, degrees(pose.theta));
}

std::string kind_in_words(const std::string& kind, const char* all) {
  return kind == "*" ? all : '\'' + kind + '\'';
}

/// Says what a condition asks of its subject, the bodies or joints of `kind`.
struct ConditionWords {
  const std::string& kind;
  double metre;

  std::string operator()(const tasks::CentreIn& c) const {
    return "lies " + region_in_words(c.region, metre);
  }
  std::string operator()(const tasks::MeanIn& c) const {
    return "lies " + region_in_words(c.region, metre);
  }
  std::string operator()(const tasks::AngleIn& c) const {
    return "has an angle " + angles_in_words(c.least, c.most);
  }
  std::string operator()(const tasks::JointIn& c) const {
    return c.type == JointType::kPrismatic
               ? print("is between %.4g and %.4g m", metre * c.least, metre * c.most)
               : "has an angle " + angles_in_words(c.least, c.most);
  }
  std::string operator()(const tasks::PoseNear& c) const {
    return print("is within %.4g m and %.4g deg of ", metre * c.distance, degrees(c.turn)) +
           pose_in_words(c.pose, metre);
  }
  std::string operator()(const tasks::Covers& c) const {
    return print("covers %.4g%% of its outline at ", 100.0 * c.share) +
           pose_in_words(c.pose, metre);
  }
  std::string operator()(const tasks::Touches& c) const {
    return print("is at most %.4g m away from ", metre * c.gap) +
           (may_be(c.other) ? "another " : "a ") + kind_in_words(c.other, "object");
  }
  std::string operator()(const tasks::KeepsFrom& c) const {
    return print("is at least %.4g m away from every ", metre * c.gap) +
           (may_be(c.other) ? "other " : "") + kind_in_words(c.other, "object");
  }
  std::string operator()(const tasks::Stays& c) const {
    return print("has its centre within %.4g m of its place above", metre * c.distance);
  }

 private:
  /// Returns whether a body of the subject may be one of `other`, too.
  bool may_be(const std::string& other) const {
    return other == kind || other == "*" || kind == "*";
  }
};

std::string term_in_words(const tasks::GoalTerm& term, double metre) {
  std::string every = term.negated ? "  no " : "  every ";
  if (std::holds_alternative<tasks::CentreIn>(term.condition)) every.insert(2, "the centre of ");
  std::string who;
  if (std::holds_alternative<tasks::JointIn>(term.condition))
    who = term.kind == "*"
              ? every + "joint"
              : (term.negated ? "  not: the joint of '" : "  the joint of '") + term.kind + "'";
  else if (std::holds_alternative<tasks::MeanIn>(term.condition))
    who = (term.negated ? "  not: the mean centre of all " : "  the mean centre of all ") +
          kind_in_words(term.kind, "movable objects");
  else
    who = every + kind_in_words(term.kind, "movable object");
  return who + ' ' + std::visit(ConditionWords{term.kind, metre}, term.condition) + '\n';
}

/// Returns whether an object that can move, or the tree of joints that it belongs to, has no range.
bool some_start_in_places(const tasks::Task& task) {
  const std::vector<std::size_t> roots = roots_of(task.scene);
  for (std::size_t i = 1; i < task.scene.size(); ++i)
    if (!task.scene.bodies[roots[i]].fixed && !task.start_range(roots[i])) return true;
  return false;
}

std::string task_in_words(const Config& config) {
  const tasks::Task& task = config.task;
  const double metre = task.units.length;
  std::string out = "task " + task.name + "\n" + bodies_in_words(task) + heavy_in_words(config) +
                    joints_in_words(task) + "goal, all of\n";
  for (const tasks::GoalTerm& term : task.goal) out += term_in_words(term, metre);
  const PushConfig& push = task.push;
  std::string strides;
  for (const double stride : push.strides)
    strides += (strides.empty() ? "" : " or ") + print("%.4g", metre * stride);
  out += print(
      "actions\n  %d headings, %.4g degrees apart; a push is %s m straight ahead, "
      "within |x|, |y| <= %.4g m\n",
      push.headings, 360.0 / push.headings, strides.c_str(), metre * push.arena);
  out += print("episodes\n  at most %d pushes, observation of %d numbers\n", task.horizon,
               observation_size(task));
  if (some_start_in_places(task))
    out += print("  %s start within %.4g m of the layout above (training: %.4g m)\n",
                 task.start_ranges.empty() ? "objects" : "objects without a range",
                 metre * config.evaluation_jitter(), metre * config.training_jitter());
  return out;
}

/// Returns the learner's discount, with the setting that it is from and the one that does not hold.
std::string discount_in_words(const Config& config) {
  std::string out = print("discount %.4g", config.learner_discount());
  if (config.train.discount == 0.0) return out + " (the task's, as train.discount is 0)";
  if (config.train.discount == config.task.discount) return out;
  return out + print(" (train.discount; 0 there takes task.discount, %.4g)", config.task.discount);
}

std::string training_in_words(const Config& config) {
  const TrainConfig& train = config.train;
  if (train.learner == Learner::kPlanning) return "  search forwards from each start\n";
  const std::string from =
      train.offline ? print("from %d transitions on",
                            std::min(train.transitions_before_learning, config.search.transitions))
                    : "without offline data";
  return print("  train for %d interactions, preset %s, %s, %s\n", train.interactions,
               kTrainPresets[static_cast<std::size_t>(train.preset)].data(),
               discount_in_words(config).c_str(), from.c_str());
}

std::string processes_in_words(const RunConfig& run) {
  return print("  seed %d, %d reverse workers, %s\n", run.seed, run.workers,
               run.in_process ? "all in one process" : ("bus " + run.bus).c_str());
}

std::string work_in_words(const Config& config) {
  const search::SearchConfig& search = config.search;
  const TrainConfig& train = config.train;
  const RunConfig& run = config.run;
  const auto method = kMethods[static_cast<std::size_t>(run.method)];
  std::string out = print("work by method %s\n", method.data());
  if (!train.offline) return out + training_in_words(config) + processes_in_words(run);
  out += print(
      "  generate %d transitions by %s, %d other headings with each step\n", search.transitions,
      search::kGenerators[static_cast<std::size_t>(search.generator)].data(), search.branches);
  return out + training_in_words(config) + processes_in_words(run);
}

}  // namespace

std::vector<std::string> heavy_bodies(const Config& config) {
  const Scene& scene = config.task.scene;
  const std::vector<double> shares = paces(scene, config.physics);
  std::vector<std::string> out;
  for (std::size_t i = 1; i < shares.size(); ++i)
    if (shares[i] < 0.5)
      out.push_back(
          print("'%s' by %.2g of a stride at most", scene.bodies[i].name.c_str(), shares[i]));
  return out;
}

std::string description(const Config& config) {
  return task_in_words(config) + work_in_words(config);
}

}  // namespace rtg::config
