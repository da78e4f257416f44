#include "core/tasks/task.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/forward/free_path.hpp"
#include "core/search/predecessor.hpp"
#include "core/search/start_distance.hpp"
#include "core/tasks/contact_heading.hpp"
#include "core/tasks/goal_marks.hpp"
#include "core/tasks/goal_sampler.hpp"
#include "core/tasks/symmetry.hpp"
#include "core/world/outline.hpp"
#include "core/world/separation.hpp"
#include "nodes/config/config.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"
#include "train/bindings/fields.hpp"
#include "train/bindings/state_defect.hpp"
#include "train/bindings/vertices.hpp"

namespace rtg::bindings {
namespace {

std::vector<std::vector<Vertices>> outlines(const tasks::Task& task) {
  std::vector<std::vector<Vertices>> out;
  for (const Body& body : task.scene.bodies) {
    std::vector<Vertices>& rings = out.emplace_back();
    for (const std::vector<Vector2d>& ring : outline(body.shape.parts()))
      rings.push_back(vertices_of(ring));
  }
  return out;
}

std::vector<std::string> names(const tasks::Task& task) {
  std::vector<std::string> out;
  for (const Body& body : task.scene.bodies) out.push_back(body.name);
  return out;
}

std::vector<std::string> kinds(const tasks::Task& task) {
  std::vector<std::string> out;
  for (const Body& body : task.scene.bodies) out.push_back(body.kind);
  return out;
}

std::vector<bool> fixed(const tasks::Task& task) {
  std::vector<bool> out;
  for (const Body& body : task.scene.bodies) out.push_back(body.fixed);
  return out;
}

nb::ndarray<nb::numpy, float> observations(const tasks::Task& task, const StateArray& states) {
  check_bodies(states, task.scene.size());
  const auto size = static_cast<std::size_t>(observation_size(task));
  OwnedArray<float> out(states.shape(0) * size);
  {
    const nb::gil_scoped_release release;
    for (std::size_t row = 0; row < states.shape(0); ++row) {
      const std::vector<float> one = observation(task, state_at(states, row));
      std::copy(one.begin(), one.end(), out.data.get() + row * size);
    }
  }
  return out.release({states.shape(0), size});
}

nb::ndarray<nb::numpy, bool> successes(const tasks::Task& task, const StateArray& states) {
  check_bodies(states, task.scene.size());
  OwnedArray<bool> out(states.shape(0));
  for (std::size_t row = 0; row < states.shape(0); ++row)
    out.data[row] = succeeded(task, state_at(states, row));
  return out.release({states.shape(0)});
}

std::string defect_of(const tasks::Task& task, const StateArray& state) {
  return state_defect(task, only_state(state, task.scene.size()));
}

/// Returns states in metres as the core takes them. `name`: that of the argument, for ValueError.
nb::ndarray<nb::numpy, double> from_metres(const tasks::Task& task, const StateArray& states,
                                           const std::string& name) {
  const double metre = task.units.metre();
  const std::size_t bodies = task.scene.size();
  check_bodies(states, bodies);
  OwnedArray<double> out(states.shape(0) * bodies * 3);
  for (std::size_t row = 0; row < states.shape(0); ++row) {
    Poses poses = state_at(states, row);
    for (Pose& pose : poses) pose = {metre * pose.x, metre * pose.y, pose.theta};
    if (!is_finite(poses))
      throw nb::value_error(
          (name + " hold numbers that are not finite; legal: finite ones").c_str());
    if (const std::string defect = place_defect(task, poses); !defect.empty())
      throw nb::value_error(
          (name + ": row " + std::to_string(row) + " has " + defect +
           "; legal: metres. Files of runs and environments have the unit of the task, of which "
           "rtg.Task.outer() makes metres")
              .c_str());
    for (std::size_t i = 0; i < bodies; ++i)
      if (task.scene.bodies[i].fixed) poses[i] = task.start[i];
    write_state(poses, out.data.get() + row * bodies * 3);
  }
  return out.release({states.shape(0), bodies, 3});
}

nb::ndarray<nb::numpy, bool> legal_states(const tasks::Task& task, const StateArray& states) {
  check_bodies(states, task.scene.size());
  OwnedArray<bool> out(states.shape(0));
  for (std::size_t row = 0; row < states.shape(0); ++row)
    out.data[row] = state_defect(task, state_at(states, row)).empty();
  return out.release({states.shape(0)});
}

nb::ndarray<nb::numpy, bool> in_start_regions(const tasks::Task& task, const StateArray& states) {
  check_bodies(states, task.scene.size());
  const search::StateMetric metric(task.scene);
  OwnedArray<bool> out(states.shape(0));
  for (std::size_t row = 0; row < states.shape(0); ++row)
    out.data[row] = search::in_start_region(task, metric, state_at(states, row));
  return out.release({states.shape(0)});
}

nb::ndarray<nb::numpy, bool> moved(const tasks::Task& task, const StateArray& states,
                                   const StateArray& next_states) {
  check_bodies(states, task.scene.size());
  check_bodies(next_states, task.scene.size());
  if (states.shape(0) != next_states.shape(0))
    throw nb::value_error((std::to_string(states.shape(0)) + " states but " +
                           std::to_string(next_states.shape(0)) +
                           " next states; legal: equally many")
                              .c_str());
  OwnedArray<bool> out(states.shape(0) * task.scene.size());
  bool* to = out.data.get();
  for (std::size_t row = 0; row < states.shape(0); ++row) {
    const Poses before = state_at(states, row), after = state_at(next_states, row);
    for (std::size_t i = 0; i < before.size(); ++i) *to++ = search::has_moved(before[i], after[i]);
  }
  return out.release({states.shape(0), task.scene.size()});
}

/// Returns the stroke of each action as a vector. [N] -> [N, 2]
nb::ndarray<nb::numpy, double> ways(const tasks::Task& task, const ActionArray& actions) {
  check_actions(actions, action_count(task.push));
  OwnedArray<double> out(actions.shape(0) * 2);
  double* to = out.data.get();
  for (std::size_t row = 0; row < actions.shape(0); ++row) {
    const Stroke stroke = stroke_of(static_cast<int>(actions.data()[row]), task.push);
    *to++ = stroke.length * stroke.direction.x();
    *to++ = stroke.length * stroke.direction.y();
  }
  return out.release({actions.shape(0), 2});
}

/// Returns one contact_heading() per state. Row k draws from random stream k of `seed`.
nb::ndarray<nb::numpy, std::int64_t> contact_headings(const tasks::Task& task,
                                                      const StateArray& states,
                                                      std::uint64_t seed) {
  check_bodies(states, task.scene.size());
  OwnedArray<std::int64_t> out(states.shape(0));
  for (std::size_t row = 0; row < states.shape(0); ++row) {
    Rng rng(seed, row);
    out.data[row] = contact_heading(task, state_at(states, row), rng);
  }
  return out.release({states.shape(0)});
}

std::optional<nb::ndarray<nb::numpy, double>> goal_state(const tasks::Task& task,
                                                         std::uint64_t seed, std::uint64_t index) {
  Rng rng(seed, index);
  const std::optional<Poses> poses = sample_goal(task, rng);
  if (!poses) return std::nullopt;
  return state_array(*poses);
}

std::string why_no_goal_state(const tasks::Task& task, std::uint64_t seed, std::uint64_t index) {
  Rng rng(seed, index);
  tasks::Refusals refusals;
  if (sample_goal(task, rng, &refusals)) return "";
  return main_reason(refusals, task.scene);
}

nb::ndarray<nb::numpy, double> start(const tasks::Task& task, double amplitude, std::uint64_t seed,
                                     std::uint64_t index) {
  if (!(amplitude >= 0.0 && amplitude <= 10.0))
    throw nb::value_error(
        ("amplitude " + std::to_string(amplitude) + " is out of range; legal: 0 to 10").c_str());
  Rng rng(seed, index);
  return state_array(jittered_start(task, amplitude, rng));
}

std::vector<double> turn_periods(const tasks::Task& task) {
  std::vector<double> out;
  for (std::size_t i = 0; i < task.scene.size(); ++i)
    out.push_back(tasks::turn_period(task.scene, i));
  return out;
}

/// Returns the strides, the longest one being 1.
std::vector<double> strides(const tasks::Task& task) {
  std::vector<double> out;
  for (const double stride : task.push.strides) out.push_back(stride / longest_stride(task.push));
  return out;
}

/// Returns the joints as (parent, child, points in the frame of the parent): the pin of a revolute
/// joint, the ends of the axis of a prismatic one.
std::vector<std::tuple<int, int, std::vector<Vector2d>>> joints(const tasks::Task& task) {
  std::vector<std::tuple<int, int, std::vector<Vector2d>>> out;
  const double most = 2.0 * task.push.arena;
  for (const Joint& joint : task.scene.joints) {
    std::vector<Vector2d> points;
    if (joint.type == JointType::kRevolute) points = {joint.on_parent};
    if (joint.type == JointType::kPrismatic)
      for (const double value : {joint.lower, joint.upper})
        points.emplace_back(joint.on_parent + std::clamp(value, -most, most) * joint.axis);
    out.emplace_back(joint.parent, joint.child, std::move(points));
  }
  return out;
}

/// Returns for each joint whether its value meets all goal terms on it. The result is false for
/// joints without a goal term.
std::vector<bool> joints_reached(const tasks::Task& task, const StateArray& states) {
  const Poses poses = only_state(states, task.scene.size());
  std::vector<bool> out;
  for (const Joint& joint : task.scene.joints) {
    int asked = 0, held = 0;
    for (const tasks::GoalTerm& term : task.goal) {
      if (!concerns(term, task.scene, joint)) continue;
      ++asked;
      held += excess(term, joint, poses) <= 0.0;
    }
    out.push_back(asked > 0 && held == asked);
  }
  return out;
}

std::vector<tasks::GoalMark> joint_marks(const tasks::Task& task, const StateArray& states) {
  return tasks::joint_marks(task, only_state(states, task.scene.size()));
}

std::vector<tasks::GoalMark> body_marks(const tasks::Task& task, const StateArray& states) {
  return tasks::body_marks(task, only_state(states, task.scene.size()));
}

/// Returns one mean centre per goal term with a mean: that of the bodies to which it applies.
std::vector<Vector2d> centroids(const tasks::Task& task, const StateArray& states) {
  const Poses poses = only_state(states, task.scene.size());
  std::vector<Vector2d> out;
  for (const tasks::GoalTerm& term : task.goal)
    if (std::holds_alternative<tasks::MeanIn>(term.condition))
      out.push_back(centroid_of(term, task.scene, poses));
  return out;
}

void bind_goal_mark(nb::module_& module) {
  nb::class_<tasks::GoalMark>(module, "GoalMark",
                              "What a picture shows of a goal term: an area of the plane.")
      .def_ro("kind", &tasks::GoalMark::kind,
              "The kind of the bodies that the term is about; \"*\": all objects.")
      .def_prop_ro(
          "ring", [](const tasks::GoalMark& mark) { return vertices_of(mark.ring); },
          "The area's vertices, [V, 2] in m.")
      .def_ro("target", &tasks::GoalMark::target,
              "Whether the area is the outline of a body where it is to lie.")
      .def_ro("negated", &tasks::GoalMark::negated, "Whether the area is to be avoided.");
}

/// Returns in which states the robot can go its way, to the border of the arena at most, without
/// coming near a body.
nb::ndarray<nb::numpy, bool> is_free(const tasks::Task& task, const StateArray& states,
                                     const WayArray& ways) {
  check_bodies(states, task.scene.size());
  check_ways(ways, states.shape(0));
  OwnedArray<bool> out(states.shape(0));
  for (std::size_t row = 0; row < states.shape(0); ++row) {
    const Poses poses = state_at(states, row);
    const Vector2d way(ways.data()[2 * row], ways.data()[2 * row + 1]);
    const Pose to = push_target(poses[0], {way.normalized(), way.norm()}, task.push);
    const double length = (to.position() - poses[0].position()).norm();
    out.data[row] = forward::free_path_length(task.scene, poses, to) >= length;
  }
  return out.release({states.shape(0)});
}

/// Bodies, joints and goal.
void bind_geometry(nb::class_<tasks::Task>& bound) {
  bound.def_ro("name", &tasks::Task::name, "The name of the task.")
      .def_prop_ro("outlines", &outlines,
                   "The outer ring of each body, then its holes. [vertices, 2] in m, centroid at 0")
      .def("is_free", &is_free, nb::arg("states"), nb::arg("ways"),
           R"(Returns where the robot's way meets no body. [N, bodies, 3], [N, 2] -> [N]

It then keeps at least 0.05 from all of them. Raises ValueError for arrays that do not fit.)")
      .def_prop_ro(
          "scene",
          [](const tasks::Task& task) {
            return std::make_pair(task.scene.bodies, task.scene.joints);
          },
          "The bodies and joints, in units of the core.")
      .def_prop_ro("names", &names, "The unique names of the bodies.")
      .def_prop_ro("kinds", &kinds, "The class of each body.")
      .def_prop_ro("fixed", &fixed, "True for each body that never moves.")
      .def_prop_ro(
          "joints", &joints,
          R"(The joints: (parent body, child body, points in the frame of the parent [2], m).

The pin of a revolute joint, both ends of the axis of a prismatic one, none of a fixed one.)")
      .def_prop_ro("goal_marks", &tasks::goal_marks,
                   "The regions and target outlines of the goal, for pictures.")
      .def("body_marks", &body_marks, nb::arg("states"),
           R"(Returns the marks of the goal's angles and distances, which go with the bodies.

Sectors of the directions that a body's x axis may have, and outlines grown by a gap. `states`: a
single state, [1, bodies, 3].)")
      .def("joint_marks", &joint_marks, nb::arg("states"),
           R"(Returns where the children of joints lie at the values that the goal allows.

Those with `target` lie at the ends of a range. `states`: a single state, [1, bodies, 3].)")
      .def_prop_ro(
          "arena", [](const tasks::Task& task) { return task.push.arena; },
          "Half width of the square that the robot stays in [m].");
}

/// Metres and kilograms.
void bind_units(nb::class_<tasks::Task>& bound) {
  bound
      .def("from_metres", &from_metres, nb::arg("states"), nb::arg("name") = "states",
           R"(Returns states in metres in the unit of the poses. [N, bodies, 3] -> [N, bodies, 3]

Fixed bodies come to lie in their places to the bit. `name`: that of the argument. Raises
ValueError for numbers that are not finite, for fixed bodies off their places, and for others
out of twice the arena.)")
      .def_prop_ro(
          "kilogram", [](const tasks::Task& task) { return task.units.kilogram(); },
          "One kilogram, in the unit of masses: that in which the robot's density is 1.")
      .def_prop_ro(
          "metre", [](const tasks::Task& task) { return task.units.metre(); },
          "One metre, in the unit of lengths of poses: that in which the robot's radius is 0.8.");
}

/// What a learner sees and does.
void bind_interface(nb::class_<tasks::Task>& bound) {
  bound
      .def_prop_ro("position_unit", &tasks::position_unit,
                   "Unit of positions in an observation [m].")
      .def_prop_ro("relative_unit", &tasks::relative_unit,
                   "Unit of relative positions in an observation [m].")
      .def_prop_ro(
          "headings", [](const tasks::Task& task) { return task.push.headings; },
          "Number of headings of a push.")
      .def_prop_ro("strides", &strides, "Lengths of a push, the longest one being 1.")
      .def_prop_ro(
          "actions", [](const tasks::Task& task) { return action_count(task.push); },
          "Number of actions: action a has the heading a % headings, the stride a // headings.")
      .def_prop_ro(
          "start", [](const tasks::Task& task) { return state_array(task.start); },
          nb::rv_policy::move, "The nominal start. [bodies, 3]")
      .def_prop_ro(
          "robot_entries", [](const tasks::Task& task) { return robot_is_turned(task) ? 4 : 2; },
          "Number of the entries of an observation that are about the robot; the first ones.")
      .def_prop_ro(
          "bodies", [](const tasks::Task& task) { return task.scene.size(); },
          "Number of bodies, with the robot.")
      .def_prop_ro("observation_size", &tasks::observation_size,
                   "Number of entries of an observation.")
      .def_prop_ro(
          "interchangeable", &tasks::interchangeable,
          R"(The movable objects in groups: to swap two of a group changes nothing but their names.

Most often each is alone in its group.)")
      .def_prop_ro(
          "turn_periods", &turn_periods,
          "The angles by which each body can be turned without any change; 0 of discs [rad].")
      .def_prop_ro(
          "content", &config::task_hash,
          "The hash of bodies, joints, goal and pushes: of what a policy of the task is about.");
}

/// Functions of states.
void bind_states(nb::class_<tasks::Task>& bound) {
  bound
      .def("observation", &observations, nb::arg("states"),
           "Returns the observations of the states. [N, bodies, 3] -> [N, observation_size]")
      .def("joints_reached", &joints_reached, nb::arg("states"),
           R"(Returns, for each joint, whether the goal constrains its angle and the angle complies.

`states`: a single state, [1, bodies, 3].)")
      .def("centroids", &centroids, nb::arg("states"),
           R"(Returns the mean centre for each goal term with subject "centroid", each [2].

`states`: a single state, [1, bodies, 3].)")
      .def("contact_headings", &contact_headings, nb::arg("states"), nb::arg("seed"),
           R"(Draws, for each state, a heading towards a random movable object.

Entry k depends only on state k, `seed` and k. [N, bodies, 3] -> [N])")
      .def("goal_state", &goal_state, nb::arg("seed"), nb::arg("index") = 0,
           R"(Samples a state in which the goal holds and the bodies are nearly at rest. [bodies, 3]

It is sample `index` of random stream `seed`. Returns None if 1,000 attempts fail.)")
      .def("why_no_goal_state", &why_no_goal_state, nb::arg("seed"), nb::arg("index") = 0,
           "Returns what failed most often, in words, if goal_state() returns None; else \"\".")
      .def("succeeded", &successes, nb::arg("states"),
           "Returns whether the goal holds in each state. [N, bodies, 3] -> [N]")
      .def("is_legal", &legal_states, nb::arg("states"),
           R"(Returns which states an episode can be in. [N, bodies, 3] -> [N]

They are finite, no bodies overlap by more than 0.03 m, movable ones are within twice the
arena, and fixed ones in their places.)")
      .def("defect", &defect_of, nb::arg("states"),
           R"(Returns why no episode can be in a state, in words; empty if is_legal().

`states`: a single state, [1, bodies, 3].)")
      .def("moved", &moved, nb::arg("states"), nb::arg("next_states"),
           R"(Returns which bodies are more than 0.05 units from where they were. [N, bodies]

The robot has a radius of 0.8 units. Turns do not count. `states`, `next_states`: [N, bodies, 3] each.)")
      .def("ways", &ways, nb::arg("actions"),
           R"(Returns the ways (x, y) of the robot that actions ask for. [N] -> [N, 2]

They are in the unit of the poses, of which `metre` make a metre.

Raises ValueError for an action that the task does not have.)")
      .def("in_start_region", &in_start_regions, nb::arg("states"),
           R"(Returns whether all objects are in place of a start. [N, bodies, 3] -> [N]

They are within 0.4 m of the start, or of the region that they start in; the robot may be
anywhere.)")
      .def("jittered_start", &start, nb::arg("amplitude"), nb::arg("seed"), nb::arg("index") = 0,
           R"(Samples a start: the nominal one, objects moved by up to ± `amplitude` [m] in x and y.

It is sample `index` of random stream `seed`. [bodies, 3]

Raises ValueError if 1000 draws in a row are illegal (bodies overlap, an object is outside
the arena, or the goal holds). Raises ValueError if `amplitude` is outside [0, 10] m.)");
}

}  // namespace

void bind_task(nb::module_& module) {
  bind_goal_mark(module);
  nb::class_<tasks::Task> bound(module, "Task", R"(A task with sparse reward. Body 0 is the robot.

The reward is 1 when the goal holds, else 0. Success ends the episode.)");
  bind_fields(bound);
  bind_geometry(bound);
  bind_units(bound);
  bind_interface(bound);
  bind_states(bound);
  bound.def("__reduce__", [](const tasks::Task& task) {
    config::Config config;
    config.task = task;
    return nb::make_tuple(nb::module_::import_("rtg.pickling").attr("task_of"),
                          nb::make_tuple(canonical_yaml(config)));
  });
}

}  // namespace rtg::bindings
