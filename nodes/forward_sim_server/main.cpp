// rtg_forward_sim_server CONFIG.yaml RUN
//
// Answers replay jobs with the true dynamics, Box2D, for the coordinator of the run named RUN until
// it leaves. CONFIG.yaml is the resolved configuration of the run; as many units are answered at
// once as the run has workers, which wait for the replays meanwhile.

#include "core/search/batches_on_threads.hpp"
#include "core/search/simulators.hpp"
#include "nodes/config/config.hpp"
#include "nodes/program/program.hpp"
#include "nodes/program/serve.hpp"

namespace rtg {
namespace {

int run(const Words& words) {
  const Config config = load_config(words[0]);
  const ReplayOne replay = forward_replay(config.task, config.physics);
  Bus bus(config.run.bus, words[1]);
  WorkerNode<ReplayService> node(bus,
                              {shape_of(config.task), config_hash(config), 0, config.run.workers},
                              replay_on_threads(replay, 1));
  return serve(bus, node);
}

}  // namespace
}  // namespace rtg

int main(int argc, char** argv) {
  return rtg::run_program(argc, argv, "CONFIG.yaml RUN", rtg::run);
}
