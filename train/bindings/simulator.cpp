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

std::pair<nb::ndarray<nb::numpy, double>, nb::ndarray<nb::numpy, bool>> push(
    const TaskSimulator& simulator, const StateArray& states, const ActionArray& actions) {
  check_bodies(states, simulator.bodies);
  check_actions(actions, states.shape(0), simulator.actions);
  const std::size_t count = states.shape(0), width = simulator.bodies * 3;
  OwnedArray<double> next(count * width);
  OwnedArray<bool> ok(count);
  {
    const nb::gil_scoped_release release;
    for (std::size_t row = 0; row < count; ++row) {
      const int action = static_cast<int>(actions.data()[row]);
      const forward::PushOutcome outcome = simulator.pushes->push(state_at(states, row), action);
      write_state(outcome.end, next.data.get() + row * width);
      ok.data[row] = outcome.ok;
    }
  }
  return {next.release({count, simulator.bodies, 3}), ok.release({count})};
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
Raises ValueError for arrays that do not fit the task.)");
}

}  // namespace rtg::bindings
