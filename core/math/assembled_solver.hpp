#pragma once

#include <memory>

#include "core/math/kkt_solver.hpp"
#include "core/math/stage_system.hpp"

namespace rtg {

/// A StageSystem as a symmetric block-tridiagonal matrix and a right-hand side, with the centred
/// pairing. Block k holds the poses after sub-step k, its control and the multipliers of its
/// residual,
///
///   ζ_k = (Δp_k, Δc_k, Δy_k), k = 1 ... h;  ζ_0 = Δp_0.
///
/// If the final state is fixed (Δp_h = 0), block h would have no poses. Then block k holds the
/// control and the multipliers of the next sub-step,
///
///   ζ_k = (Δp_k, Δc_{k+1}, Δy_{k+1}), k = 0 ... h-1.
///
/// Inertia couples three successive states, so that a block holds two sub-steps: the blocks are
/// ζ_0, (ζ_1, ζ_2), (ζ_3, ζ_4), ... With inertia the final state must not be fixed.
///
/// Departs from the paper: its printed pairing is pentadiagonal.
class Assembled {
 public:
  Assembled(const StageSystem<double>& system, bool fixed_end);

  const BlockTridiagonal& matrix() const { return K_; }
  const BlockVector& right_hand_side() const { return r_; }
  /// Convert a vector of the system to a step, and back.
  void read(const BlockVector& x, StageStep<double>& step) const;
  BlockVector written(const StageStep<double>& step) const;

 private:
  /// Position of the first row of a variable: its block, and the row within this block.
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

  int M_, n_, h_, per_block_;  // bodies, entries of Δp_k, sub-steps, sub-steps per block
  bool fixed_end_;
  BlockTridiagonal K_;
  BlockVector r_;
};

/// Solves the assembled system by any KktMethod, which includes the paper's method and the
/// reference methods for the others.
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
