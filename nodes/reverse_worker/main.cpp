// rtg_reverse_worker CONFIG.yaml RUN [NUMBER]
//
// Solves reverse jobs for the coordinator of the run named RUN until it leaves. CONFIG.yaml is the
// resolved configuration of the run; NUMBER tells workers apart for people.

#include "core/search/batches_on_threads.hpp"
#include "core/search/simulators.hpp"
#include "nodes/config/config.hpp"
#include "nodes/program/program.hpp"
#include "nodes/program/serve.hpp"

namespace rtg {
namespace {

int run(const Words& words) {
  const int number = words.size() > 2 ? number_word(words[2], "NUMBER") : 0;
  const Config config = load_config(words[0]);
  const SolveBatch solve =
      reverse_solver(config.task, config.physics, config.reverse, config.search.generator);
  Bus bus(config.run.bus, words[1]);
  WorkerNode<ReverseService> node(bus, {shape_of(config.task), config_hash(config), number, 1},
                               solve_on_threads(solve, 1));
  return serve(bus, node);
}

}  // namespace
}  // namespace rtg

int main(int argc, char** argv) {
  return rtg::run_program(argc, argv, "CONFIG.yaml RUN [NUMBER]", rtg::run);
}
