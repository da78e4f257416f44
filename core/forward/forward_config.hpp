#pragma once

#include <string>
#include <string_view>

namespace rtg::forward {

/// The engines of this library; see make_simulator().
inline constexpr std::string_view kBox2d = "box2d";  // Box2dSimulator
inline constexpr std::string_view kNewton =
    "newton";  // NewtonSimulator, the model of reverse solves

/// Names what a run takes for the true dynamics: of replays, training and evaluation.
struct ForwardConfig {
  /// kBox2d, kNewton, or an engine outside this library, which the caller brings along: "mujoco" or
  /// "module:Class", a class in Python.
  std::string engine{kBox2d};
  /// Factor of the coefficients of friction. The reverse model keeps those of the task, so another
  /// value than 1 is a model that is wrong by as much.
  double friction = 1.0;

  bool is_built_in() const { return engine == kBox2d || engine == kNewton; }

  template <class Visitor>
  void visit(Visitor& v) {
    v.text("engine", engine,
           "forward simulator of replays, training and evaluation; box2d, newton, mujoco, "
           "module:Class");
    v.number("friction", friction, 0.0, 10.0,
             "friction of the forward simulator, as a multiple of the task's; the reverse model "
             "keeps the task's");
  }
};

}  // namespace rtg::forward
