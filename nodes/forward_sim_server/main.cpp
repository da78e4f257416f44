// rtg_forward_sim_server CONFIG.yaml KEY
//
// Simulates the pushes of replay jobs (the true dynamics) for the run whose key file is KEY, until
// the coordinator leaves. CONFIG.yaml is the resolved configuration of the run. The server uses as
// many threads as the run has reverse workers, because these are idle during replays.

#include "core/search/simulators.hpp"
#include "nodes/config/config.hpp"
#include "nodes/program/program.hpp"
#include "nodes/program/serve.hpp"

namespace rtg::forward_sim_server {
namespace {

int run(const program::Words& words) {
  const config::Config config = config::load_config(words[0]);
  const search::ReplayOne replay =
      search::forward_replay(config.task, config.physics, config.forward);
  bus::Bus bus(config.run.bus, bus::RunKey::read(words[1]));
  jobs::WorkerNode<jobs::ReplayService> node(
      bus, {program::shape_of(config.task), config_hash(config), 0, config.run.workers},
      replay_on_threads(replay, 1));
  return program::serve(bus, node);
}

}  // namespace
}  // namespace rtg::forward_sim_server

int main(int argc, char** argv) {
  return rtg::program::run(argc, argv, "CONFIG.yaml KEY", rtg::forward_sim_server::run);
}
