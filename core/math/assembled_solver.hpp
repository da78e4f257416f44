#pragma once

#include <memory>

#include "core/math/kkt_solver.hpp"
#include "core/math/stage_system.hpp"

namespace rtg {

/// A StageSystem assembled as K ζ = r, with K symmetric and block-tridiagonal. Block k pairs the
/// poses after sub-step k with the control and the multipliers of the same sub-step ("centred
/// pairing"):
///
///   ζ_k = (Δp_k, Δc_k, Δy_k), k = 1 ... h;  ζ_0 = Δp_0.
///
/// Inertia couples three successive poses, and if the final state is fixed (Δp_h = 0), block h
/// would have no poses. In both cases the poses are paired with the next sub-step instead, so that
/// the middle one of its three poses is in its block:
///
///   ζ_k = (Δp_k, Δc_{k+1}, Δy_{k+1}), k = 0 ... h-1;  ζ_h = Δp_h unless it is fixed.
///
/// Only second derivatives U of the Lagrangian (periodic turns, joints) couple p_{k+1} and p_{k-1}
/// then: where there are any, a block holds two sub-steps, (ζ_0, ζ_1), (ζ_2, ζ_3), ...
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
  bool has_pose(int level) const { return level < h_ || !fixed_end_; }
  RowPosition pose(int level) const;
  RowPosition control(int step) const;
  RowPosition multiplier(int step) const;
  void set_sizes();
  void add_stage(const StageSystem<double>::Stage& stage, int k);
  double& entry(const RowPosition& row, const RowPosition& column);
  void add(const BlockMatrix<double>& M, const RowPosition& row, const RowPosition& column);
  void add_symmetric(const BlockMatrix<double>& M, const RowPosition& row,
                     const RowPosition& column);

  void reserve(const RowPosition& at, int rows);

  int M_, n_, h_;  // bodies, entries of Δp_k, sub-steps
  bool fixed_end_;
  bool centred_;              // a block has the poses after its sub-step, not before it
  bool couples_outer_poses_;  // p_{k+1} and p_{k-1}
  int per_block_;             // ζ_k per block
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
