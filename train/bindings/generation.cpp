#include <nanobind/stl/function.h>
#include <nanobind/stl/string.h>

#include <utility>

#include "core/search/simulators.hpp"
#include "nodes/common/rtg_config.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg {
namespace {

/// Calls store(poses, action, next_poses, success, source) with arrays of the rows.
void hand_over(const nb::object& store, std::span<const Transition> rows) {
  const nb::gil_scoped_acquire acquire;
  const std::size_t count = rows.size(), bodies = count ? rows[0].poses.size() : 0;
  OwnedArray<double> poses(count * bodies * 3), next(count * bodies * 3);
  OwnedArray<std::int32_t> action(count);
  OwnedArray<bool> success(count);
  OwnedArray<std::int8_t> source(count);
  for (std::size_t k = 0; k < count; ++k) {
    write_state(rows[k].poses, poses.data.get() + k * bodies * 3);
    write_state(rows[k].next, next.data.get() + k * bodies * 3);
    action.data[k] = rows[k].action;
    success.data[k] = rows[k].success;
    source.data[k] = static_cast<std::int8_t>(rows[k].source);
  }
  store(poses.release({count, bodies, 3}), action.release({count}),
        next.release({count, bodies, 3}), success.release({count}), source.release({count}));
}

void report_progress(const nb::object& progress, const Progress& p) {
  const nb::gil_scoped_acquire acquire;
  nb::dict line;
  line["phase"] = p.phase;
  line["layer"] = p.layer;
  line["depth"] = p.depth;
  line["transitions"] = p.transitions;
  line["target"] = p.target;
  line["contact_share"] = p.contact_share;
  line["start_region"] = p.start_region;
  progress(line);
}

/// Exceptions of the callbacks, KeyboardInterrupt too, end the generation and come out of it.
std::string generate_in_process(const RtgConfig& config, const nb::object& store,
                                const nb::object& progress) {
  const nb::gil_scoped_release release;
  GenerationSeams seams = in_process_seams(
      reverse_solver(config.task, config.physics, config.reverse, config.search.reverse),
      forward_replay(config.task, config.physics), config.run.workers);
  seams.store = [&](std::span<const Transition> rows) { hand_over(store, rows); };
  seams.progress = [&](const Progress& p) { report_progress(progress, p); };
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  return to_json(generate(config.task, config.search, seed, seams));
}

}  // namespace

void bind_generation(nb::module_& module) {
  module.def("generate", &generate_in_process, nb::arg("config"), nb::arg("store"),
             nb::arg("progress"));
}

}  // namespace rtg
