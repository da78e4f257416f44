#include "train/bindings/engine.hpp"

#include <errno.h>
#include <nanobind/stl/filesystem.h>

#include <filesystem>
#include <string>

#include "core/search/simulators.hpp"
#include "core/threads/cpu_clock.hpp"
#include "nodes/jobs/worker_node.hpp"
#include "nodes/program/program.hpp"
#include "nodes/program/serve.hpp"
#include "nodes/program/shutdown.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg::bindings {
namespace {

using Flags = nb::ndarray<const bool, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

/// Asks the function `engine` for the ends of pushes.
std::vector<search::ReplayResult> ask(nb::handle engine, std::size_t bodies,
                                      std::span<const search::ReplayJob> jobs) {
  if (jobs.empty()) return {};
  const nb::gil_scoped_acquire acquire;
  const double begin = threads::process_cpu_s();
  OwnedArray<double> states(jobs.size() * bodies * 3);
  OwnedArray<std::int64_t> actions(jobs.size());
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    write_state(jobs[k].start, states.data.get() + k * bodies * 3);
    actions.data[k] = jobs[k].action;
  }
  const nb::tuple answer = nb::cast<nb::tuple>(
      engine(states.release({jobs.size(), bodies, 3}), actions.release({jobs.size()})));
  const auto ends = nb::cast<StateArray>(answer[0]);
  const auto ok = nb::cast<Flags>(answer[1]);
  check_bodies(ends, bodies);
  if (ends.shape(0) != jobs.size() || ok.shape(0) != jobs.size())
    throw nb::value_error("the engine answered for another number of states");
  const double each = (threads::process_cpu_s() - begin) / static_cast<double>(jobs.size());
  std::vector<search::ReplayResult> results;
  for (std::size_t k = 0; k < jobs.size(); ++k)
    results.push_back({state_at(ends, k), ok.data()[k], each});
  return results;
}

/// Simulates replay jobs with `engine` for the run of a configuration file whose key file is `key`,
/// until its coordinator leaves. Returns the exit status of the process.
int serve_replays(const std::filesystem::path& file, const std::filesystem::path& key,
                  const nb::object& engine) {
  const nb::gil_scoped_release release;
  static char name[] = "rtg_forward_sim_server";
  program_invocation_short_name = name;  // not "python"
  program::watch_signals();
  const config::Config config = config::load_config(file);
  bus::Bus bus(config.run.bus, bus::RunKey::read(key));
  jobs::WorkerNode<jobs::ReplayService> node(
      bus, {program::shape_of(config.task), config_hash(config)}, replays(config, engine));
  return program::serve(bus, node);
}

}  // namespace

search::ReplayBatch replays(const config::Config& config, nb::handle engine) {
  if (config.forward.is_built_in())
    return search::replay_on_threads(
        search::forward_replay(config.task, config.physics, config.forward), config.run.workers);
  if (engine.is_none())
    throw nb::value_error(("no function for the engine " + config.forward.engine).c_str());
  return [engine, bodies = config.task.scene.size()](std::span<const search::ReplayJob> jobs) {
    return ask(engine, bodies, jobs);
  };
}

void bind_engine(nb::module_& module) {
  module.attr("SETTLE") = search::kSettle;
  module.def("serve_replays", &serve_replays, nb::arg("config"), nb::arg("key"), nb::arg("engine"),
             R"(Serves the replay jobs of a run by `engine` until its coordinator leaves.

`config`: the file with the resolved configuration, `key`: that with the key of the run.
`engine`: as of generate(). Returns the exit status of the process. Raises the exceptions of
`engine`, RuntimeError if the coordinator falls silent.)");
}

}  // namespace rtg::bindings
