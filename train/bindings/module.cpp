#include "train/bindings/bindings.hpp"

NB_MODULE(_core, module) {
  module.doc() = "The C++ core of RTG: tasks, the true dynamics, generation.";
  rtg::bind_task(module);
  rtg::bind_simulator(module);
}
