#pragma once

#include <nanobind/nanobind.h>

namespace rtg::bindings {

/// Each of these functions binds one part of the core to the Python module rtg._core.
void bind_bus(nanobind::module_& module);
void bind_config(nanobind::module_& module);
void bind_engine(nanobind::module_& module);
void bind_energy(nanobind::module_& module);
void bind_generation(nanobind::module_& module);
void bind_network(nanobind::module_& module);
void bind_task(nanobind::module_& module);
void bind_reverse(nanobind::module_& module);
void bind_scene(nanobind::module_& module);
void bind_search(nanobind::module_& module);
void bind_simulator(nanobind::module_& module);

}  // namespace rtg::bindings
