#include "core/forward/make_simulator.hpp"

#include <stdexcept>

#include "core/forward/box2d_simulator.hpp"
#include "core/forward/newton_simulator.hpp"

namespace rtg::forward {

std::unique_ptr<const Simulator> make_simulator(const ForwardConfig& config, const Scene& scene,
                                                const PushConfig& push,
                                                const PhysicsConfig& physics) {
  if (!config.is_built_in())
    throw std::invalid_argument("the engine '" + config.engine + "' is none of this library");
  Scene actual = scene;
  for (Body& body : actual.bodies) body.friction *= config.friction;
  if (config.engine == kNewton) return std::make_unique<NewtonSimulator>(actual, push, physics);
  return std::make_unique<Box2dSimulator>(actual, push, physics);
}

}  // namespace rtg::forward
