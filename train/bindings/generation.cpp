#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "core/search/forward_search.hpp"
#include "core/search/generate.hpp"
#include "core/search/search_config.hpp"
#include "core/search/simulators.hpp"
#include "nodes/config/config.hpp"
#include "nodes/jobs/journaled.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"
#include "train/bindings/engine.hpp"
#include "train/bindings/fields.hpp"
#include "train/bindings/transition_arrays.hpp"

namespace rtg::bindings {
namespace {

/// Passes `rows` to Python: calls store(poses, action, next_poses, success, source).
void hand_over(const nb::object& store, std::span<const search::Transition> rows) {
  const nb::gil_scoped_acquire acquire;
  store(*transition_arrays(rows));
}

void report_progress(const nb::object& progress, const search::Progress& p) {
  const nb::gil_scoped_acquire acquire;
  nb::dict line;
  line["phase"] = p.phase;
  line["layer"] = p.layer;
  line["depth"] = p.depth;
  line["transitions"] = p.transitions;
  line["target"] = p.target;
  line["contact_share"] = p.contact_share;
  line["starts_reached"] = p.starts_reached;
  progress(line);
}

/// Generates transitions in this process and returns the report as JSON. Calls `store` with
/// transitions and `progress` with the state of the search. An exception of a callback, including
/// KeyboardInterrupt, ends the generation and propagates to the caller. Throws JournalError if the
/// file `journal` cannot be used.
std::string generate_in_process(const config::Config& config, const nb::object& store,
                                const nb::object& progress,
                                const std::optional<std::filesystem::path>& journal,
                                const nb::object& engine) {
  const nb::gil_scoped_release release;
  search::GenerationSeams seams =
      search::in_process_seams(config.task, config.physics, config.reverse, config.search.generator,
                               config.run.workers, replays(config, engine));
  std::optional<jobs::UnitJournal> known;
  if (journal)
    keep_in(known.emplace(*journal, generation_hash(config)),
            {static_cast<int>(config.task.scene.size()), action_count(config.task.push)}, seams);
  seams.store = [&](std::span<const search::Transition> rows) { hand_over(store, rows); };
  seams.progress = [&](const search::Progress& p) { report_progress(progress, p); };
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  search::GenerationReport report = generate(config.task, config.search, seed, seams);
  if (known) {
    report.units_from_journal = known->units_found();
    report.journal_bytes_dropped = known->dropped_bytes();
    report.generate_cpu_s += known->cpu_s_found();
  }
  return to_json(report);
}

/// Searches forwards for a plan from `start` [1, bodies, 3] to the goal. Returns the states of the
/// plan [T + 1, bodies, 3] and the number of pushes that the search simulated. If the search finds
/// no plan, the start is the only state. Throws ValueError unless `start` is one state.
std::pair<nb::ndarray<nb::numpy, double>, long> plan(const config::Config& config,
                                                     const StateArray& start,
                                                     const nb::object& engine) {
  const tasks::Task& task = config.task;
  const Poses from = only_state(start, task.scene.size());
  search::SearchStats stats;
  std::vector<search::Transition> steps;
  {
    const nb::gil_scoped_release release;
    const search::ReplayBatch replay =
        counted(replays(config, engine), stats, search::Stage::kReplays);
    steps = plan_forward(task, config.search, from, replay);
  }
  const std::size_t width = task.scene.size() * 3;
  OwnedArray<double> states((steps.size() + 1) * width);
  write_state(from, states.data.get());
  for (std::size_t k = 0; k < steps.size(); ++k)
    write_state(steps[k].next, states.data.get() + (k + 1) * width);
  return {states.release({steps.size() + 1, task.scene.size(), 3}), stats.replays};
}

}  // namespace

void bind_generation(nb::module_& module) {
  module.attr("GENERATORS") = names_of(search::kGenerators);
  module.attr("SOURCES") = names_of(search::kSources);
  nb::exception<journal::JournalError>(module, "JournalError", PyExc_OSError).attr("__doc__") =
      "A journal that cannot be read or written. The message names its file.";
  module.def(
      "generate", &generate_in_process, nb::arg("config"), nb::arg("store"), nb::arg("progress"),
      nb::arg("journal") = nb::none(), nb::arg("engine") = nb::none(),
      R"(Generates transitions in this process, on run.workers threads. Returns the report as JSON.

Calls store(poses, action, next_poses, success, source) with the transitions in sequence order.
Calls progress() after each layer of the search, with a dictionary of "phase", "layer", "depth",
"transitions", "target", "contact_share" and "starts_reached". An exception of either function
ends the generation and is raised.

The answers of the simulators are added to the file `journal`, if one is given, as they come. A
generation that was killed and begins anew takes them from there and goes on to the same rows.
Raises JournalError if the file cannot be used.

`engine` simulates the pushes if forward.engine is not built in: a function of states
[N, bodies, 3] and actions [N], SETTLE among them, that returns the states afterwards and whether
each push could be finished [N].)");
  module.def("share_of_shard", &search::share_of_shard, nb::arg("search"), nb::arg("k"),
             "Returns how many of the transitions shard k = 0 ... shards - 1 is to store.");
  module.def("plan", &plan, nb::arg("config"), nb::arg("start"), nb::arg("engine") = nb::none(),
             R"(Searches for a plan from `start`, [1, bodies, 3], by forward beam search.

Returns the states of the plan, [T + 1, bodies, 3], and the number of simulated pushes. Without
a plan, the states are only the start. `engine`: as of generate(). Raises ValueError if `start`
does not fit the task.)");
}

}  // namespace rtg::bindings
