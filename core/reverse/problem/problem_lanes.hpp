#pragma once

#include "core/reverse/problem/reverse_problem.hpp"
#include "core/reverse/problem/speed_penalty.hpp"

namespace rtg::reverse {

template <class T>
struct Trajectory;

/// Reverse problems of several candidates, one per SIMD lane of T. All have the same numbers of
/// bodies.
template <class T>
struct ProblemLanes {
  /// Allocates empty lanes for problems with as many bodies, and movable bodies, as `like`, joints
  /// between the same bodies, and the same physics constants, `config`, `sub_steps` and `settling`.
  explicit ProblemLanes(const ReverseProblem& like);
  void load(int lane, const ReverseProblem& one);

  bool fixed_end() const { return config.terminal_weight == 0.0; }
  /// Returns whether p_k has to match the final state. This holds for p_h and, with inertia, for
  /// p_{h-1}, as bodies must come to rest.
  bool is_terminal(int k) const { return k >= sub_steps - (energy.inertial() ? 1 : 0); }
  /// Returns the robot's pose (t̄₀, θ̄₀) after sub-step k on its straight path to the final state.
  Vec3<T> robot_path(int k) const;
  /// Returns the speed penalty of object i in sub-step k.
  SpeedPenalty<T> speed(const Trajectory<T>& x, int k, int i) const;

  energy::SceneModel<T> energy;
  const ReverseConfig& config;
  std::vector<T> end;  // p̄ [3·bodies]
  Vec2<T> direction;
  T pace;
  int sub_steps, settling;
};

/// Iterates of several candidates, one per lane; see Iterate for the members. Contacts are numbered
/// as in energy::SceneModel. With joints, the multipliers are those of all poses, w = J y
/// (Articulation). They contain y.
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

/// A number for each contact at each level. Level 0 is the start, level k the end of sub-step k.
/// [h + 1][contacts]
template <class T>
using PerContact = std::vector<std::vector<T>>;

}  // namespace rtg::reverse
