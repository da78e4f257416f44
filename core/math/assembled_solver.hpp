#pragma once

#include <memory>

#include "core/math/kkt_solver.hpp"
#include "core/math/stage_system.hpp"

namespace rtg {

/// A StageSystem as a symmetric block-tridiagonal matrix and right-hand side, with the centred
/// pairing: block k holds the pose after sub-step k, its control and the multiplier of its
/// residual,
///
///   ζ_k = (Δp_k, Δc_k, Δy_k), k = 1 ... h;  ζ_0 = Δp_0,
///
/// or, where the final state is fixed (Δp_h = 0) and block h would have no pose, those of the next
/// sub-step,
///
///   ζ_k = (Δp_k, Δc_{k+1}, Δy_{k+1}), k = 0 ... h-1.
///
/// With inertia, which couples three levels, a block holds two sub-steps: (ζ_1, ζ_2), (ζ_3, ζ_4),
/// ... after ζ_0; the final state is not fixed then.
///
/// Departs from the paper: its printed pairing is pentadiagonal.
class Assembled {
 public:
  Assembled(const StageSystem<double>& system, bool fixed_end);

  const BlockTridiagonal& matrix() const { return K_; }
  const BlockVector& right_hand_side() const { return r_; }
  /// The step that a vector of the system stands for, and back.
  void read(const BlockVector& x, StageStep<double>& step) const;
  BlockVector written(const StageStep<double>& step) const;

 private:
  /// First row of something, within its block.
  struct Place {
    int block, row;
  };
  bool has_pose(int level) const { return level < h_ || !fixed_end_; }
  Place pose(int level) const;
  Place control(int step) const;
  Place multiplier(int step) const;
  void set_sizes();
  void add_stage(const StageSystem<double>::Stage& stage, int k);
  double& entry(const Place& row, const Place& column);
  void add(const BlockMatrix<double>& M, const Place& row, const Place& column);
  void add_symmetric(const BlockMatrix<double>& M, const Place& row, const Place& column);

  int M_, n_, h_, per_block_;  // sub-steps per block
  bool fixed_end_;
  BlockTridiagonal K_;
  BlockVector r_;
};

/// Solves the assembled matrix by any of the methods: the paper's, and the oracle of the others.
class AssembledSolver final : public StageSolver<double> {
 public:
  AssembledSolver(KktMethod method, bool fixed_end)
      : kkt_(make_kkt_solver(method)), fixed_end_(fixed_end) {}

  bool solve(const StageSystem<double>& system, StageStep<double>& step) override;

 private:
  std::unique_ptr<KktSolver> kkt_;
  bool fixed_end_;
};

}  // namespace rtg
