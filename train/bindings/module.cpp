#include "core/forward/box2d_simulator.hpp"
#include "train/bindings/bindings.hpp"

NB_MODULE(_core, module) {
  nanobind::set_leak_warnings(false);  // sys.exit() leaves objects to the end of the process
  module.doc() =
      "The C++ core of RTG: configuration, tasks, the true dynamics, generation, "
      "values of headings, the bus.";
  module.attr("PROCESSOR") = RTG_PROCESSOR;  // what -march was given
  module.attr("BOX2D_VERSION") = rtg::forward::Box2dSimulator::library_version().c_str();
  rtg::bindings::bind_scene(module);
  rtg::bindings::bind_task(module);
  rtg::bindings::bind_config(module);
  rtg::bindings::bind_simulator(module);
  rtg::bindings::bind_energy(module);
  rtg::bindings::bind_engine(module);
  rtg::bindings::bind_reverse(module);
  rtg::bindings::bind_search(module);
  rtg::bindings::bind_generation(module);
  rtg::bindings::bind_network(module);
  rtg::bindings::bind_bus(module);
}
