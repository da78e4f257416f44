#include "core/math/assembled_solver.hpp"

namespace rtg {
namespace {

constexpr double kMultiplierShift = 1e-9;  // on the multipliers' diagonal, against a singular E

void write(const BlockColumn<double>& from, double sign, VectorXd& to, Eigen::Index at) {
  for (std::size_t i = 0; i < from.size(); ++i)
    to.segment<3>(at + static_cast<Eigen::Index>(3 * i)) = sign * from[i];
}

void read_column(const VectorXd& from, Eigen::Index at, BlockColumn<double>& to) {
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] = from.segment<3>(at + static_cast<Eigen::Index>(3 * i));
}

}  // namespace

Assembled::Assembled(const StageSystem<double>& system, bool fixed_end)
    : M_(system.M), n_(3 * system.M), h_(system.h), fixed_end_(fixed_end) {
  const int blocks = fixed_end ? h_ : h_ + 1;
  for (int k = 0; k < blocks; ++k) {
    const int rows = k == 0 && !fixed_end ? n_ : 2 * n_ + 3;
    K_.A.push_back(MatrixXd::Zero(rows, rows));
    K_.B.push_back(k == 0 ? MatrixXd() : MatrixXd::Zero(rows, K_.A[k - 1].cols()));
    r_.push_back(VectorXd::Zero(rows));
  }
  for (int k = 0; k <= h_; ++k) {
    const auto& stage = system.stages[k];
    if (has_pose(k)) {
      add(stage.Q, true, k, 0, k);
      write(stage.q, -1.0, r_[k], 0);
    }
    if (k == 0) continue;
    const int own = block_of(k);
    if (has_pose(k)) {
      add(stage.E, true, own, n_ + 3, k);
      add(stage.N, false, k, 0, k - 1);
    }
    add(stage.F, false, own, n_ + 3, k - 1);
    for (int m = 0; m < 3; ++m) {
      entry(own, n_ + m, own, n_ + m) += stage.R[m];
      entry(own, n_ + 3 + m, own, n_ + m) += stage.B[m];
      r_[own][n_ + m] = -stage.r[m];
    }
    for (int m = 0; m < n_; ++m) entry(own, n_ + 3 + m, own, n_ + 3 + m) -= kMultiplierShift;
    write(stage.e, -1.0, r_[own], n_ + 3);
  }
  for (MatrixXd& A : K_.A) A = MatrixXd(A.selfadjointView<Eigen::Lower>());
}

/// Below (or on) the diagonal of K.
double& Assembled::entry(int row_block, int row, int column_block, int column) {
  if (row_block < column_block) return entry(column_block, column, row_block, row);
  return row_block == column_block ? K_.A[row_block](row, column) : K_.B[row_block](row, column);
}

/// M with its rows from `row` of a block, its columns those of the poses of another.
void Assembled::add(const BlockMatrix<double>& M, bool symmetric, int row_block, int row,
                    int column_block) {
  for (int i = 0; i < M_; ++i)
    for (int j = 0; j < M_; ++j) {
      const bool mirrored = symmetric && j > i;
      if (!(mirrored ? M.has(j, i) : M.has(i, j))) continue;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const int at = row + 3 * i + a, column = 3 * j + b;
          if (row_block == column_block && at < column) continue;
          entry(row_block, at, column_block, column) +=
              mirrored ? M.at(j, i)(b, a) : M.at(i, j)(a, b);
        }
    }
}

void Assembled::read(const BlockVector& x, StageStep<double>& step) const {
  for (int k = 0; k <= h_; ++k) {
    if (has_pose(k))
      read_column(x[k], 0, step.poses[k]);
    else
      for (Vec3<double>& block : step.poses[k]) block.setZero();
    if (k == 0) continue;
    step.controls[k] = x[block_of(k)].segment<3>(n_);
    read_column(x[block_of(k)], n_ + 3, step.multipliers[k]);
  }
}

BlockVector Assembled::written(const StageStep<double>& step) const {
  BlockVector x;
  for (const VectorXd& block : r_) x.push_back(VectorXd::Zero(block.size()));
  for (int k = 0; k <= h_; ++k) {
    if (has_pose(k)) write(step.poses[k], 1.0, x[k], 0);
    if (k == 0) continue;
    x[block_of(k)].segment<3>(n_) = step.controls[k];
    write(step.multipliers[k], 1.0, x[block_of(k)], n_ + 3);
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
