#pragma once

#include <memory>

#include "core/math/kkt_solver.hpp"
#include "core/math/stage_system.hpp"

namespace rtg {

/// A StageSystem assembled as K ζ = r, with K symmetric and block-tridiagonal. Block k pairs the
/// poses after sub-step k with the control and the multipliers of the next one:
///
///   ζ_k = (Δp_k, Δc_{k+1}, Δy_{k+1}), k = 0 ... h-1;  ζ_h = Δp_h, if the final state is not fixed.
///
/// The constraint of sub-step k + 1 joins p_{k+1}, p_k and, with inertia, p_{k-1}: it is paired
/// with the middle one of its three poses, so that a block is coupled with its neighbours alone.
/// Only second derivatives U of the Lagrangian (periodic turns, joints) couple p_{k+1} and p_{k-1}.
/// Where there are any, a block holds two sub-steps: (ζ_0, ζ_1), (ζ_2, ζ_3), ...
///
/// Departs from the paper: A.3 pairs a constraint with the first of its three poses, so that with
/// inertia the matrix is block-pentadiagonal, not tridiagonal.
class Assembled {
 public:
  Assembled(const StageSystem<double>& system, bool fixed_end);

  const BlockTridiagonal& matrix() const { return K_; }
  const BlockVector& right_hand_side() const { return r_; }
  /// Copies the vector `x` of the system into `step`. written() does the reverse.
  void read(const BlockVector& x, StageStep<double>& step) const;
  BlockVector written(const StageStep<double>& step) const;

 private:
  /// Position of the first row of a variable: its block of the system, and the row within the
  /// block.
  struct RowPosition {
    int block, row;
  };
  bool has_pose(int level) const { return level <= last_; }
  RowPosition pose(int level) const;
  RowPosition control(int step) const;
  RowPosition multiplier(int step) const;
  void set_sizes();
  void add_stage(const StageSystem<double>::Stage& stage, int k);
  double& entry(const RowPosition& row, const RowPosition& column);
  void add(const BlockMatrix<double>& M, const RowPosition& row, const RowPosition& column);
  void add_symmetric(const BlockMatrix<double>& M, const RowPosition& row,
                     const RowPosition& column);

  int M_, n_, h_, last_, per_block_;  // bodies, entries of Δp_k, h, last k with Δp_k, ζ_k per block
  BlockTridiagonal K_;
  BlockVector r_;
};

/// Assembles a StageSystem and solves it by any KktMethod: the paper's cyclic reduction or one of
/// the methods that it is compared with.
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
