#pragma once

#include "core/reverse/problem/reverse_problem.hpp"
#include "core/reverse/problem/speed_penalty.hpp"

namespace rtg::reverse {

template <class T>
struct Trajectory;

/// Reverse problems of as many candidates as T has lanes, all with the same numbers of bodies.
template <class T>
struct ProblemLanes {
  /// Allocates lanes for problems with the structure and configuration of `like`; loads none.
  explicit ProblemLanes(const ReverseProblem& like);
  void load(int lane, const ReverseProblem& one);

  bool fixed_end() const { return config.terminal_weight == 0.0; }
  /// Returns whether the final state prescribes the poses after sub-step k: those after the last
  /// sub-step and, with inertia, those one sub-step before.
  bool ends(int k) const { return k >= sub_steps - (energy.inertial() ? 1 : 0); }
  /// Returns (t̄₀, θ̄₀), the robot's pose on its straight path, after sub-step k.
  Vec3<T> robot_path(int k) const;
  /// Returns the speed penalty of object i in sub-step k.
  SpeedPenalty<T> speed(const Trajectory<T>& x, int k, int i) const;

  energy::SceneModel<T> energy;
  const ReverseConfig& config;
  std::vector<T> end;  // p̄ [3·bodies]
  Vec2<T> direction;
  T terminal_weight;  // K
  int sub_steps, settling;
};

/// Trajectories with their forces and multipliers, an Iterate per lane. Contacts are numbered as in
/// energy::SceneModel. Where bodies are jointed, the multipliers are those of all poses, w = J y; y
/// is part of w.
template <class T>
struct Trajectory {
  Trajectory(const energy::SceneModel<T>& energy, int sub_steps);
  void load(int lane, const ReverseProblem& problem, const Iterate& x);
  Iterate unload(int lane, const ReverseProblem& problem) const;
  /// Copies lane `from` of `other` to `lane`.
  void copy_lane(int lane, const Trajectory& other, int from);
  /// Copies `other` in the lanes `where`.
  void assign(const Mask<T>& where, const Trajectory& other);

  std::vector<energy::Placement<T>> p;
  std::vector<std::vector<T>> forces;
  std::vector<Vec3<T>> controls;
  std::vector<std::vector<T>> multipliers;
};

/// Numbers per level and contact [h + 1][contacts].
template <class T>
using PerContact = std::vector<std::vector<T>>;

}  // namespace rtg::reverse
