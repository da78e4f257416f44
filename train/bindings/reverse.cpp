#include "core/reverse/reverse_simulator.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "core/search/simulators.hpp"
#include "nodes/config/config.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"
#include "train/bindings/fields.hpp"

namespace rtg::bindings {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<std::string_view, reverse::kSolveStatusCount> status_names() {
  std::array<std::string_view, reverse::kSolveStatusCount> names;
  for (int k = 0; k < reverse::kSolveStatusCount; ++k)
    names[static_cast<std::size_t>(k)] = name(static_cast<reverse::SolveStatus>(k));
  return names;
}

/// The reverse simulator of one task.
struct TaskReverse {
  config::Config config;
  std::size_t bodies, sub_steps;
  int actions;
  double metre, kilogram;  // in the units of the simulator
  reverse::ReverseSimulator simulator;

  explicit TaskReverse(const config::Config& given)
      : config(given),
        bodies(config.task.scene.size()),
        sub_steps(
            static_cast<std::size_t>(config.physics.sub_steps + config.physics.settling_steps())),
        actions(action_count(config.task.push)),
        metre(config.task.units.metre()),
        kilogram(config.task.units.kilogram()),
        simulator(config.task.scene, config.physics, config.task.push, config.reverse) {}
};

/// An array [N, ...] of which each solve writes a row; rows that are not written are NaN.
struct Rows {
  OwnedArray<double> numbers;
  std::size_t width;

  Rows(std::size_t count, std::size_t row_width) : numbers(count * row_width), width(row_width) {
    std::fill_n(numbers.data.get(), count * row_width, kNothing);
  }
  double* row(std::size_t k) { return numbers.data.get() + k * width; }
};

/// The contacts of all solves, one after another.
nb::dict contact_arrays(const TaskReverse& reverse,
                        const std::vector<reverse::ReverseResult>& results) {
  const double metre = reverse.metre, newton = reverse.kilogram * metre;
  std::size_t count = 0;
  for (const auto& r : results) count += r.solution ? r.solution->contacts.size() : 0;
  OwnedArray<std::int64_t> solve(count), sub_step(count), body(count), other(count);
  OwnedArray<double> point(2 * count), normal(2 * count), force(count);
  std::size_t at = 0;
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (!results[k].solution) continue;
    for (const reverse::ContactForce& c : results[k].solution->contacts) {
      solve.data[at] = static_cast<std::int64_t>(k);
      sub_step.data[at] = c.sub_step;
      body.data[at] = c.body;
      other.data[at] = c.other;
      for (int i = 0; i < 2; ++i) {
        point.data[2 * at + i] = c.point[i] / metre;
        normal.data[2 * at + i] = c.normal[i];
      }
      force.data[at++] = c.force / newton;
    }
  }
  nb::dict out;
  out["solve"] = solve.release({count});
  out["sub_step"] = sub_step.release({count});
  out["body"] = body.release({count});
  out["other"] = other.release({count});
  out["point"] = point.release({count, 2});
  out["normal"] = normal.release({count, 2});
  out["force"] = force.release({count});
  return out;
}

nb::dict result_arrays(const TaskReverse& reverse,
                       const std::vector<reverse::ReverseResult>& results) {
  const std::size_t count = results.size(), levels = reverse.sub_steps + 1;
  const std::size_t bodies = reverse.bodies;
  const double metre = reverse.metre, joule = reverse.kilogram * metre * metre;
  constexpr auto kStarts = static_cast<std::size_t>(reverse::kMaxPredecessors);
  OwnedArray<std::int64_t> status(count), iterations(count), found(count);
  Rows starts(count, kStarts * bodies * 3), trajectory(count, levels * bodies * 3);
  Rows controls(count, reverse.sub_steps * 3), figures(count, 3);
  for (std::size_t k = 0; k < count; ++k) {
    const reverse::ReverseResult& r = results[k];
    status.data[k] = static_cast<std::int64_t>(r.status);
    iterations.data[k] = r.iterations;
    found.data[k] = static_cast<std::int64_t>(r.predecessors.size());
    for (std::size_t n = 0; n < r.predecessors.size(); ++n)
      write_state(r.predecessors[n], starts.row(k) + n * bodies * 3, metre);
    if (!r.solution) continue;
    for (std::size_t n = 0; n < levels; ++n)
      write_state(r.solution->trajectory[n], trajectory.row(k) + n * bodies * 3, metre);
    for (std::size_t n = 0; n < reverse.sub_steps; ++n)
      std::copy_n(r.solution->controls[n].data(), 3, controls.row(k) + 3 * n);
    figures.row(k)[0] = r.solution->objective / joule;
    figures.row(k)[1] = r.solution->infeasibility;
    figures.row(k)[2] = r.solution->stationarity;
  }
  nb::dict out;
  out["status"] = status.release({count});
  out["iterations"] = iterations.release({count});
  out["found"] = found.release({count});
  out["starts"] = starts.numbers.release({count, kStarts, bodies, 3});
  out["trajectory"] = trajectory.numbers.release({count, levels, bodies, 3});
  out["controls"] = controls.numbers.release({count, reverse.sub_steps, 3});
  out["figures"] = figures.numbers.release({count, 3});
  out["contacts"] = contact_arrays(reverse, results);
  return out;
}

nb::dict solve(const TaskReverse& reverse, const StateArray& ends, const ActionArray& actions,
               int threads) {
  check_bodies(ends, reverse.bodies);
  check_actions(actions, ends.shape(0), reverse.actions);
  if (threads < 1)
    throw nb::value_error((std::to_string(threads) + " threads; legal: at least 1").c_str());
  std::vector<reverse::ReverseResult> results;
  {
    const nb::gil_scoped_release release;
    std::vector<reverse::ReverseJob> jobs;
    jobs.reserve(ends.shape(0));
    for (std::size_t k = 0; k < ends.shape(0); ++k)
      jobs.push_back({state_at(ends, k), static_cast<int>(actions.data()[k]), true});
    const auto solve_some = [&](std::span<const reverse::ReverseJob> some) {
      return reverse.simulator.solve(some);
    };
    results = search::solve_on_threads(solve_some, threads)(jobs);
  }
  return result_arrays(reverse, results);
}

}  // namespace

void bind_reverse(nb::module_& module) {
  static constexpr auto kStatusNames = status_names();
  module.attr("SOLVE_STATUSES") = names_of(kStatusNames);
  nb::class_<TaskReverse>(module, "ReverseSimulator",
                          "Solves the reverse problems of a task; see rtg.reverse.")
      .def(nb::init<const config::Config&>(), nb::arg("config"))
      .def("__reduce__",
           [](const TaskReverse& reverse) {
             return nb::make_tuple(nb::type<TaskReverse>(), nb::make_tuple(reverse.config));
           })
      .def("solve", &solve, nb::arg("ends"), nb::arg("actions"), nb::arg("threads") = 1,
           R"(Solves N problems. [N, bodies, 3], [N]

`ends` are in units of the core. Results are in metres, kilograms and seconds, except
infeasibility and stationarity, which are in units of the core: the arrays "status" (into
SOLVE_STATUSES), "iterations" and "found" (number of starts) [N], "starts" [N, 8, bodies, 3],
"trajectory" [N, h + 1, bodies, 3], "controls" [N, h, 3], "figures" (objective, infeasibility,
stationarity) [N, 3], NaN where there is none, and "contacts": the arrays "solve", "sub_step",
"body", "other", "force" [C], "point" and "normal" [C, 2]. Raises ValueError for arrays that do
not fit the task.)");
}

}  // namespace rtg::bindings
