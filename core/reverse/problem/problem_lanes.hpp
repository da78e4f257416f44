#pragma once

#include "core/reverse/problem/reverse_problem.hpp"
#include "core/reverse/problem/speed_penalty.hpp"

namespace rtg::reverse {

template <class T>
struct Trajectory;

/// Reverse problems of as many candidates as T has lanes, over the same numbers of bodies.
template <class T>
struct ProblemLanes {
  /// Room for problems like that one; nothing is loaded yet.
  explicit ProblemLanes(const ReverseProblem& like);
  void load(int lane, const ReverseProblem& one);

  bool fixed_end() const { return config.terminal_weight == 0.0; }
  /// Says whether the final state names the poses after sub-step k: its own, and with inertia those
  /// before.
  bool ends(int k) const { return k >= sub_steps - (energy.inertial() ? 1 : 0); }
  /// (t̄₀, θ̄₀) after sub-step k.
  Vec3<T> robot_path(int k) const;
  /// The price of the speed of object i in sub-step k.
  SpeedPenalty<T> speed(const Trajectory<T>& x, int k, int i) const;

  energy::SceneModel<T> energy;
  const ReverseConfig& config;
  std::vector<T> end;  // p̄ [3·bodies]
  Vec2<T> direction;
  T terminal_weight;  // K
  int sub_steps, settling;
};

/// Trajectories with their forces and multipliers, as Iterate; contacts are numbered as the kernels
/// do. Multipliers are those of all poses, w = J y, where bodies are jointed: y is part of w.
template <class T>
struct Trajectory {
  Trajectory(const energy::SceneModel<T>& energy, int sub_steps);
  void load(int lane, const ReverseProblem& problem, const Iterate& x);
  Iterate unload(int lane, const ReverseProblem& problem) const;
  /// This lane ← another's.
  void copy_lane(int lane, const Trajectory& other, int from);
  /// Becomes the other in the lanes of the mask.
  void assign(const Mask<T>& where, const Trajectory& other);

  std::vector<energy::Placement<T>> p;
  std::vector<std::vector<T>> forces;
  std::vector<Vec3<T>> controls;
  std::vector<std::vector<T>> multipliers;
};

/// A number per level and contact.
template <class T>
using PerContact = std::vector<std::vector<T>>;

}  // namespace rtg::reverse
