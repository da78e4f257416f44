#include "train/bindings/bindings.hpp"

NB_MODULE(_core, module) {
  module.doc() = "The C++ core of RTG: configuration, tasks, the true dynamics, generation.";
  rtg::bind_task(module);
  rtg::bind_config(module);
  rtg::bind_simulator(module);
  rtg::bind_generation(module);
}
