#pragma once

#include <array>
#include <string_view>

namespace rtg::forward {

/// Implementations of Simulator.
enum class Engine {
  kBox2d,   // Box2dSimulator
  kNewton,  // NewtonSimulator: the model that the reverse simulator inverts
};
inline constexpr std::array<std::string_view, 2> kEngines{"box2d", "newton"};

/// Names what a run takes for the true dynamics: of replays, training and evaluation.
struct ForwardConfig {
  Engine engine = Engine::kBox2d;

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("engine", engine, kEngines, "forward simulator of replays, training and evaluation");
  }
};

}  // namespace rtg::forward
