#pragma once

#include "core/math/stage_system.hpp"

namespace rtg {

/// Solves a StageSystem by a Riccati recursion, O(h): block elimination from the last sub-step to
/// the first. The cost-to-go after sub-step k is a quadratic function of (Δp_k, Δp_{k-1}). It has
/// the Hessian (P Y; Yᵀ Z) and the gradient (v, z). Y, Z and z are zero without inertia. The
/// recursion backward in time is
///
///   S = E⁻¹,  N̂ = N + Y
///   W = S P S,  A = Fᵀ W - N̂ᵀ S,  X = A - ½ Fᵀ W,  V = W G - S U,  w = W e - S v
///   R' = R + B W₀₀ B,  C = B (Aᵀ)₀,  D = B V₀,  r' = r + B w₀
///   P ← Q + X F + (X F)ᵀ + Z - Cᵀ R'⁻¹ C
///   Y ← A G - Fᵀ S U - Cᵀ R'⁻¹ D
///   Z ← Gᵀ V - Uᵀ S G - Dᵀ R'⁻¹ D
///   v ← q + z + Fᵀ w - N̂ᵀ S e - Cᵀ R'⁻¹ r'
///   z ← Gᵀ w - Uᵀ S e - Dᵀ R'⁻¹ r'
///
/// and then forward in time
///
///   Δc = -R'⁻¹ (C Δp_{k-1} + D Δp_{k-2} + r'),
///   Δp_k = -S (F Δp_{k-1} + G Δp_{k-2} + B Δc + e).
///
/// S is applied by a sparse LDLᵀ factorisation of E. Q, E, F, G, N and U have the sparsity of the
/// graph of bodies in contact; P, W, A, X, V, Y and Z are dense. Only the constructor allocates
/// memory.
///
/// Departs from the paper: A.3 solves the same systems by cyclic reduction, which takes 30 times as
/// long and more on one core (`kkt` of the benchmarks) and pays only across cores.
template <class T>
class Riccati final : public StageSolver<T> {
 public:
  Riccati(int count, int sub_steps);

  /// Writes the solution of `system` to `step`. Returns the lanes in which no pivot block is
  /// singular; `step` is arbitrary in the others.
  Mask<T> solve(const StageSystem<T>& system, StageStep<T>& step) override;

 private:
  struct Gain {
    std::vector<Block<T>> C, D;  // R'⁻¹ C and R'⁻¹ D, one block per body
    Vec3<T> r;                   // R'⁻¹ r'
  };
  using Stage = typename StageSystem<T>::Stage;
  void eliminate(const Stage& stage, const Stage& before, int k);
  void set_end(const Stage& stage);
  void sandwich(const BlockLdl<T>& E);
  void couple(const Stage& stage, const BlockLdl<T>& E, int i);
  void find_NS(const Stage& stage, const BlockLdl<T>& E, int i);
  void find_w(const Stage& stage);
  Block<T> find_gain(const Stage& stage, Gain& gain);
  void fold_gradient(const Stage& before, const Stage& stage, const Gain& gain);
  void fold_hessian(const Stage& before, const Stage& stage, const Gain& gain);
  void find_V(const Stage& stage, const BlockLdl<T>& E, const Block<T>& inverse, Gain& gain);
  void carry(const Stage& stage, const Gain& gain);
  void carry_gradient(const Stage& stage, const Gain& gain);
  void roll_forward(const StageSystem<T>& system, StageStep<T>& step) const;
  void find_multipliers(const StageSystem<T>& system, StageStep<T>& step) const;

  int M_;
  std::vector<BlockLdl<T>> E_;
  BlockLdl<T> start_;
  std::vector<Gain> gain_;
  // Matrices of [M × M] blocks, row by row. P_ holds the upper half of P and later that of W. They
  // share the memory because the fastest cache is small.
  std::vector<Block<T>> P_;
  std::vector<Block<T>> X_;  // P S, then X
  std::vector<Block<T>> A_;  // only the first column if the stage has no G
  std::vector<Block<T>> Y_, Z_, V_;
  std::vector<Block<T>> US_;  // Uᵀ S
  bool has_G_ = false;        // the current stage has G
  bool has_Y_ = false;        // Y, Z and z are not zero
  BlockPattern columns_;      // pattern of F by columns
  std::vector<Block<T>> C_, D_;
  BlockColumn<T> v_, w_, z_;
  BlockColumn<T> Ne_;          // N̂ᵀ S e
  std::vector<Block<T>> row_;  // the current row of N̂ᵀ S
  BlockMatrix<T> whole_;       // lower half of P_0
  Mask<T> regular_;
};

}  // namespace rtg
