#pragma once

#include <memory>

#include "core/forward/forward_config.hpp"
#include "core/forward/simulator.hpp"

namespace rtg::forward {

/// Returns the simulator of `scene` that `config` names. All shapes of `scene` must be legal
/// (polygon_defect() is empty), and bodies[0], the robot, movable. Throws std::invalid_argument for
/// an engine outside this library.
std::unique_ptr<const Simulator> make_simulator(const ForwardConfig& config, const Scene& scene,
                                                const PushConfig& push,
                                                const PhysicsConfig& physics);

}  // namespace rtg::forward
