#pragma once

#include "core/search/seams.hpp"
#include "nodes/config/config.hpp"
#include "train/bindings/arrays.hpp"

namespace rtg::bindings {

/// Returns the replays of `config`: on its workers' number of threads, if its engine is built in.
/// Else asks `engine`, a function of Python that must outlive the result, once per batch:
///
///   engine(states [N, bodies, 3], actions [N]) -> (states [N, bodies, 3], ok [N])
///
/// Throws ValueError if `engine` is None where the engine is not built in, or answers with other
/// shapes. Takes and releases the interpreter's lock by itself.
search::ReplayBatch replays(const config::Config& config, nb::handle engine);

}  // namespace rtg::bindings
