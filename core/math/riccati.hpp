#pragma once

#include "core/math/stage_system.hpp"

namespace rtg {

/// Solves a StageSystem by block elimination in time, from the last sub-step to the first, O(h).
/// With S = E⁻¹ (sparse LDLᵀ, by the graph of the bodies in contact) and P, v the Hessian and
/// gradient of what the sub-steps from k on cost as a function of Δp_k,
///
///   W = S P S,  G = W F - S N,  w = W e - S v
///   R' = R + B W₀₀ B,  C = B (G)₀,  r' = r + B w₀
///   P ← Q + X + Xᵀ - Cᵀ R'⁻¹ C,  X = (½ Fᵀ W - Nᵀ S) F
///   v ← q + Fᵀ w - Nᵀ S e - Cᵀ R'⁻¹ r'
///
/// and forward in time Δc = -R'⁻¹ (C Δp_{k-1} + r'), Δp_k = -S (F Δp_{k-1} + B Δc + e). P is dense,
/// all else has the graph's pattern. Allocates only when made.
template <class T>
class Riccati final : public StageSolver<T> {
 public:
  Riccati(int count, int sub_steps);

  /// Regular: no pivot block is singular.
  Mask<T> solve(const StageSystem<T>& system, StageStep<T>& step) override;

 private:
  struct Gain {
    std::vector<Block<T>> C;  // R'⁻¹ C, a block per body
    Vec3<T> r;                // R'⁻¹ r'
  };
  using Stage = typename StageSystem<T>::Stage;
  void eliminate(const Stage& stage, const Stage& before, int k);
  void set_end(const Stage& stage);
  void sandwich(const BlockLdl<T>& E);
  void couple(const Stage& stage, const BlockLdl<T>& E);
  void find_coupling(const Stage& stage, const BlockLdl<T>& E, int i);
  void find_gain(const Stage& stage, Gain& gain);
  void fold(const Stage& stage, const Stage& before, const Gain& gain);
  void roll_forward(const StageSystem<T>& system, StageStep<T>& step) const;
  void find_multipliers(const StageSystem<T>& system, StageStep<T>& step) const;

  int M_;
  std::vector<BlockLdl<T>> E_;
  BlockLdl<T> start_;
  std::vector<Gain> gain_;
  std::vector<Block<T>> P_, W_, X_;  // [M × M] row by row
  BlockPattern columns_;             // of F
  std::vector<Block<T>> C_;
  BlockColumn<T> v_, w_, Se_;  // Se: S e
  std::vector<Block<T>> row_;  // at work
  BlockMatrix<T> whole_;       // P_0
  Mask<T> regular_;
};

}  // namespace rtg
