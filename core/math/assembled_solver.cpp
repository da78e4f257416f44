#include "core/math/assembled_solver.hpp"

#include <algorithm>

namespace rtg {
namespace {

// Subtracted from the diagonal of the multipliers' rows, so that K stays regular if E is singular.
constexpr double kMultiplierShift = 1e-9;

void write(const BlockColumn<double>& from, double sign, VectorXd& to, Eigen::Index at) {
  for (std::size_t i = 0; i < from.size(); ++i)
    to.segment<3>(at + static_cast<Eigen::Index>(3 * i)) = sign * from[i];
}

bool has_inertia(const StageSystem<double>& system) {
  return std::ranges::any_of(system.stages, [](const auto& stage) { return !stage.G.empty(); });
}

/// Returns whether any U_k has an entry other than zero.
bool has_second_derivatives(const StageSystem<double>& system) {
  for (const auto& stage : system.stages)
    for (int i = 0; i < system.M; ++i)
      for (const int j : Bits(stage.U.pattern[i]))
        if (!stage.U.at(i, j).isZero(0.0)) return true;
  return false;
}

void read_column(const VectorXd& from, Eigen::Index at, BlockColumn<double>& to) {
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] = from.segment<3>(at + static_cast<Eigen::Index>(3 * i));
}

}  // namespace

Assembled::Assembled(const StageSystem<double>& system, bool fixed_end)
    : M_(system.M),
      n_(3 * system.M),
      h_(system.h),
      fixed_end_(fixed_end),
      centred_(!fixed_end && !has_inertia(system)),
      couples_outer_poses_(has_second_derivatives(system)),
      per_block_(couples_outer_poses_ ? 2 : 1) {
  set_sizes();
  for (int k = 0; k <= h_; ++k) add_stage(system.stages[k], k);
  for (MatrixXd& A : K_.A) A = MatrixXd(A.selfadjointView<Eigen::Lower>());
}

Assembled::RowPosition Assembled::pose(int level) const {
  if (centred_) return {level, 0};
  return {level / per_block_, level % per_block_ * (2 * n_ + 3)};
}

Assembled::RowPosition Assembled::control(int step) const {
  const RowPosition at = pose(centred_ ? step : step - 1);
  return {at.block, at.row + n_};
}

Assembled::RowPosition Assembled::multiplier(int step) const {
  const RowPosition at = control(step);
  return {at.block, at.row + 3};
}

/// Gives the block of a variable room for its `rows` rows.
void Assembled::reserve(const RowPosition& at, int rows) {
  const auto block = static_cast<std::size_t>(at.block);
  if (r_.size() <= block) r_.resize(block + 1);
  if (r_[block].size() < at.row + rows) r_[block] = VectorXd::Zero(at.row + rows);
}

void Assembled::set_sizes() {
  for (int k = 0; k <= h_; ++k) {
    if (has_pose(k)) reserve(pose(k), n_);
    if (k > 0) reserve(multiplier(k), n_);
  }
  for (std::size_t block = 0; block < r_.size(); ++block) {
    const Eigen::Index rows = r_[block].size();
    K_.A.push_back(MatrixXd::Zero(rows, rows));
    K_.B.push_back(block == 0 ? MatrixXd() : MatrixXd::Zero(rows, r_[block - 1].size()));
  }
}

void Assembled::add_stage(const StageSystem<double>::Stage& stage, int k) {
  if (has_pose(k)) {
    add_symmetric(stage.Q, pose(k), pose(k));
    write(stage.q, -1.0, r_[pose(k).block], pose(k).row);
  }
  if (k == 0) return;
  const RowPosition c = control(k), y = multiplier(k);
  if (has_pose(k)) {
    add_symmetric(stage.E, y, pose(k));
    add(stage.N, pose(k), pose(k - 1));
    if (couples_outer_poses_ && k > 1) add(stage.U, pose(k), pose(k - 2));
  }
  add(stage.F, y, pose(k - 1));
  if (k > 1) add(stage.G, y, pose(k - 2));
  for (int m = 0; m < 3; ++m) {
    const RowPosition own{c.block, c.row + m};
    entry(own, own) += stage.R[m];
    entry({y.block, y.row + m}, own) += stage.B[m];
    r_[c.block][own.row] = -stage.r[m];
  }
  for (int m = 0; m < n_; ++m) {
    const RowPosition own{y.block, y.row + m};
    entry(own, own) -= kMultiplierShift;
  }
  write(stage.e, -1.0, r_[y.block], y.row);
}

/// Returns the entry of the symmetric K at (row, column). Only entries on or below the diagonal are
/// stored; for others it returns the one at (column, row).
double& Assembled::entry(const RowPosition& row, const RowPosition& column) {
  if (row.block < column.block || (row.block == column.block && row.row < column.row))
    return entry(column, row);
  return row.block == column.block ? K_.A[row.block](row.row, column.row)
                                   : K_.B[row.block](row.row, column.row);
}

/// Adds M to K with the upper left corner at (row, column), off the diagonal of K.
void Assembled::add(const BlockMatrix<double>& M, const RowPosition& row,
                    const RowPosition& column) {
  for (int i = 0; i < M_; ++i)
    for (const int j : Bits(M.pattern[i]))
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          entry({row.block, row.row + 3 * i + a}, {column.block, column.row + 3 * j + b}) +=
              M.at(i, j)(a, b);
}

/// Adds the symmetric M to K with the upper left corner at (row, column). Reads the lower half of M
/// only. If the block lies on the diagonal of K, writes its lower half only.
void Assembled::add_symmetric(const BlockMatrix<double>& M, const RowPosition& row,
                              const RowPosition& column) {
  const bool own = row.block == column.block && row.row == column.row;
  for (int i = 0; i < n_; ++i)
    for (int j = 0; j <= i; ++j) {
      if (!M.has(i / 3, j / 3)) continue;
      const double x = M.at(i / 3, j / 3)(i % 3, j % 3);
      entry({row.block, row.row + i}, {column.block, column.row + j}) += x;
      if (!own && i != j) entry({row.block, row.row + j}, {column.block, column.row + i}) += x;
    }
}

void Assembled::read(const BlockVector& x, StageStep<double>& step) const {
  for (int k = 0; k <= h_; ++k) {
    if (has_pose(k))
      read_column(x[pose(k).block], pose(k).row, step.poses[k]);
    else
      for (Vec3<double>& block : step.poses[k]) block.setZero();
    if (k == 0) continue;
    step.controls[k] = x[control(k).block].segment<3>(control(k).row);
    read_column(x[multiplier(k).block], multiplier(k).row, step.multipliers[k]);
  }
}

BlockVector Assembled::written(const StageStep<double>& step) const {
  BlockVector x;
  for (const VectorXd& block : r_) x.push_back(VectorXd::Zero(block.size()));
  for (int k = 0; k <= h_; ++k) {
    if (has_pose(k)) write(step.poses[k], 1.0, x[pose(k).block], pose(k).row);
    if (k == 0) continue;
    x[control(k).block].segment<3>(control(k).row) = step.controls[k];
    write(step.multipliers[k], 1.0, x[multiplier(k).block], multiplier(k).row);
  }
  return x;
}

bool AssembledSolver::solve(const StageSystem<double>& system, StageStep<double>& step) {
  const Assembled assembled(system, fixed_end_);
  if (!kkt_->factorize(assembled.matrix())) return false;
  assembled.read(kkt_->solve(assembled.right_hand_side()), step);
  return true;
}

}  // namespace rtg
