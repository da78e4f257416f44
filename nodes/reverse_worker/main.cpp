// rtg_reverse_worker CONFIG.yaml KEY [NUMBER]
//
// Solves reverse jobs of the run whose key file is KEY until the coordinator leaves. CONFIG.yaml is
// the resolved configuration of the run. NUMBER distinguishes workers in displays.

#include "core/search/simulators.hpp"
#include "nodes/config/config.hpp"
#include "nodes/program/program.hpp"
#include "nodes/program/serve.hpp"

namespace rtg::reverse_worker {
namespace {

int run(const program::Words& words) {
  const int number = words.size() > 2 ? program::parse_number(words[2], "NUMBER") : 0;
  const config::Config config = config::load_config(words[0]);
  const search::SolveBatch solve =
      reverse_solver(config.task, config.physics, config.reverse, config.search.generator);
  bus::Bus bus(config.run.bus, bus::RunKey::read(words[1]));
  jobs::WorkerNode<jobs::ReverseService> node(
      bus, {program::shape_of(config.task), config_hash(config), number, 1},
      search::solve_on_threads(solve, 1));
  return program::serve(bus, node);
}

}  // namespace
}  // namespace rtg::reverse_worker

int main(int argc, char** argv) {
  return rtg::program::run(argc, argv, "CONFIG.yaml KEY [NUMBER]", rtg::reverse_worker::run);
}
