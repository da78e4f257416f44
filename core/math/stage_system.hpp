#pragma once

#include <vector>

#include "core/math/block_ldl.hpp"

namespace rtg {

/// Newton system of an optimal control problem with implicit dynamics. It is written here as a
/// quadratic programme over h sub-steps of M bodies:
///
///   min  Σ_k ½ Δp_kᵀ Q_k Δp_k + q_k·Δp_k + Δp_kᵀ (N_k Δp_{k-1} + U_k Δp_{k-2})
///            + ½ Δc_kᵀ R_k Δc_k + r_k·Δc_k
///   s.t. E_k Δp_k + F_k Δp_{k-1} + G_k Δp_{k-2} + B_k Δc_k + e_k = 0,  k = 1 ... h
///
/// with multipliers Δy_k of the constraints. Each of Δp_0 ... Δp_h has M blocks of 3 entries. Δc_k
/// [3] acts on body 0 alone. Q_k and E_k are symmetric and given by their lower halves; R_k and B_k
/// are diagonal. G_k and U_k are the couplings by inertia, for k ≥ 2; without inertia they are
/// empty.
template <class T>
struct StageSystem {
  struct Stage {
    explicit Stage(int count)
        : Q(count),
          E(count),
          F(count),
          G(count),
          N(count),
          U(count),
          q(static_cast<std::size_t>(count), Vec3<T>::Constant(T(0.0))),
          e(q),
          R(q[0]),
          B(q[0]),
          r(q[0]) {}
    BlockMatrix<T> Q, E, F, G, N, U;
    BlockColumn<T> q, e;
    Vec3<T> R, B, r;
  };
  StageSystem(int count, int sub_steps)
      : M(count), h(sub_steps), stages(static_cast<std::size_t>(sub_steps) + 1, Stage(count)) {}

  int M, h;
  std::vector<Stage> stages;  // [h + 1]; entry 0 has only Q and q
};

/// Solution of a StageSystem; entry 0 of `controls` and `multipliers` is unused.
template <class T>
struct StageStep {
  StageStep(int count, int sub_steps)
      : poses(static_cast<std::size_t>(sub_steps) + 1,
              BlockColumn<T>(static_cast<std::size_t>(count))),
        multipliers(poses),
        controls(poses.size()) {}
  std::vector<BlockColumn<T>> poses;        // Δp_k
  std::vector<BlockColumn<T>> multipliers;  // Δy_k
  std::vector<Vec3<T>> controls;            // Δc_k
};

/// Direct solver of a StageSystem.
template <class T>
class StageSolver {
 public:
  virtual ~StageSolver() = default;

  /// Writes the solution of `system` to `step`. Returns the lanes in which the system is regular;
  /// `step` is arbitrary in the others.
  virtual Mask<T> solve(const StageSystem<T>& system, StageStep<T>& step) = 0;
};

}  // namespace rtg
