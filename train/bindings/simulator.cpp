#include <nanobind/stl/pair.h>

#include "core/forward/make_simulator.hpp"
#include "nodes/config/config.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg::bindings {
namespace {

/// The simulator of one task that defines its true dynamics.
struct TaskSimulator {
  config::Config config;
  std::size_t bodies;
  int actions;
  std::unique_ptr<const forward::Simulator> pushes;

  explicit TaskSimulator(const config::Config& given)
      : config(given),
        bodies(config.task.scene.size()),
        actions(action_count(config.task.push)),
        pushes(
            make_simulator(config.forward, config.task.scene, config.task.push, config.physics)) {}
};

using Outcomes = std::pair<nb::ndarray<nb::numpy, double>, nb::ndarray<nb::numpy, bool>>;

/// Simulates the push `stroke(row)` from each state.
template <class StrokeOfRow>
Outcomes push_each(const TaskSimulator& simulator, const StateArray& states,
                   const StrokeOfRow& stroke) {
  const std::size_t count = states.shape(0), width = simulator.bodies * 3;
  OwnedArray<double> next(count * width);
  OwnedArray<bool> ok(count);
  {
    const nb::gil_scoped_release release;
    for (std::size_t row = 0; row < count; ++row) {
      const forward::PushOutcome outcome =
          simulator.pushes->push_along(state_at(states, row), stroke(row));
      write_state(outcome.end, next.data.get() + row * width);
      ok.data[row] = outcome.ok;
    }
  }
  return {next.release({count, simulator.bodies, 3}), ok.release({count})};
}

Outcomes push(const TaskSimulator& simulator, const StateArray& states,
              const ActionArray& actions) {
  check_bodies(states, simulator.bodies);
  check_actions(actions, states.shape(0), simulator.actions);
  return push_each(simulator, states, [&](std::size_t row) {
    return stroke_of(static_cast<int>(actions.data()[row]), simulator.config.task.push);
  });
}

Outcomes push_along(const TaskSimulator& simulator, const StateArray& states,
                    const WayArray& ways) {
  check_bodies(states, simulator.bodies);
  check_ways(ways, states.shape(0));
  return push_each(simulator, states, [&](std::size_t row) {
    const Vector2d way(ways.data()[2 * row], ways.data()[2 * row + 1]);
    return Stroke{way.normalized(), way.norm()};
  });
}

}  // namespace

void bind_simulator(nb::module_& module) {
  nb::class_<TaskSimulator>(
      module, "Simulator",
      R"(Simulates the pushes of a task: the dynamics of replays, training and evaluation.

It holds no state; equal arguments give bitwise equal results.)")
      .def(nb::init<const config::Config&>(), nb::arg("config"))
      .def("__reduce__",
           [](const TaskSimulator& simulator) {
             return nb::make_tuple(nb::type<TaskSimulator>(), nb::make_tuple(simulator.config));
           })
      .def("push", &push, nb::arg("states"), nb::arg("actions"),
           R"(Simulates one push per state. [N, bodies, 3], [N] -> [N, bodies, 3], [N]

Returns the states after the pushes, and whether each push is a legal transition. It is
illegal if the simulator cannot finish it, for instance if the bodies do not come to rest.
Raises ValueError for arrays that do not fit the task.)")
      .def("push_along", &push_along, nb::arg("states"), nb::arg("ways"),
           R"(Like push(), with a way (x, y) of the robot, in any direction, instead of an action.

[N, bodies, 3], [N, 2] -> [N, bodies, 3], [N]. Raises ValueError for a way of length 0, too.)");
}

}  // namespace rtg::bindings
