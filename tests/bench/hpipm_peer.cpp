#include <hpipm_d_ocp_qp_ipm.h>
#include <hpipm_d_ocp_qp_kkt.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "core/threads/cpu_clock.hpp"
#include "tests/bench/kkt_peers.hpp"

namespace rtg::bench {
namespace {

constexpr int kPoses = 3 * kBodies;  // entries of Δp_k
using Poses = Eigen::Matrix<double, kPoses, 1>;
using Square = Eigen::Matrix<double, kPoses, kPoses>;
using Controls = Eigen::Matrix<double, kPoses, 3>;
/// Over a state: the poses of one sub-step or of two.
using OverState =
    Eigen::Matrix<double, kPoses, Eigen::Dynamic, Eigen::ColMajor, kPoses, 2 * kPoses>;

Square dense(const BlockMatrix<double>& A) {
  Square M = Square::Zero();
  for (int i = 0; i < A.M; ++i)
    for (const int j : Bits(A.pattern[i])) M.block<3, 3>(3 * i, 3 * j) = A.at(i, j);
  return M;
}

Square symmetric(const BlockMatrix<double>& A) { return dense(A).selfadjointView<Eigen::Lower>(); }

Poses dense(const BlockColumn<double>& x) { return Eigen::Map<const Poses>(x[0].data()); }

/// Sub-step k of a StageSystem. FG = (F G) and NU = (N U) are over the state before it.
struct DenseStage {
  DenseStage(const StageSystem<double>::Stage& stage, bool two_sub_steps)
      : Q(symmetric(stage.Q)),
        E(symmetric(stage.E)),
        FG(kPoses, two_sub_steps ? 2 * kPoses : kPoses),
        NU(FG),
        B(Controls::Zero()),
        q(dense(stage.q)),
        e(dense(stage.e)),
        R(stage.R.asDiagonal()),
        r(stage.r) {
    B.topRows<3>() = stage.B.asDiagonal();
    FG.leftCols<kPoses>() = dense(stage.F);
    NU.leftCols<kPoses>() = dense(stage.N);
    if (!two_sub_steps) return;
    FG.rightCols<kPoses>() = dense(stage.G);
    NU.rightCols<kPoses>() = dense(stage.U);
  }
  Square Q, E;
  OverState FG, NU;
  Controls B;
  Poses q, e;
  Eigen::Matrix3d R;
  Vector3d r;
};

/// Δp_k = A x + B u + b with the state x and the control u before it, and what
/// Δp_kᵀ NU x adds to the objective of these: xᵀ Q x + uᵀ S x + q·x.
struct ExplicitStage {
  OverState A;
  Controls B;
  Poses b;
  MatrixXd Q, S;
  VectorXd q;

  template <class Factorised>
  void set(const DenseStage& stage, const Factorised& E) {
    A = -E.solve(stage.FG);
    B = -E.solve(stage.B);
    b = -E.solve(stage.e);
    Q.noalias() = stage.NU.transpose() * A;  // its symmetric part counts
    S.noalias() = B.transpose() * stage.NU;
    q.noalias() = stage.NU.transpose() * b;
  }
};

/// Memory of one of HPIPM's objects.
class Memory {
 public:
  explicit Memory(std::size_t size) : data_(std::aligned_alloc(64, (size + 63) / 64 * 64)) {
    if (!data_) throw std::bad_alloc();
  }
  void* data() const { return data_.get(); }

 private:
  struct Free {
    void operator()(void* data) const { std::free(data); }
  };
  std::unique_ptr<void, Free> data_;
};

class HpipmPeer final : public KktPeer {
 public:
  explicit HpipmPeer(const StageSystem<double>& system)
      : h_(system.h), explicit_(system.stages.size()) {
    if (system.M != kBodies)
      throw std::logic_error("the peer is built for another number of bodies");
    for (const auto& stage : system.stages) inertial_ = inertial_ || !stage.G.empty();
    for (int k = 0; k <= h_; ++k) stages_.emplace_back(system.stages[k], inertial_ && k > 1);
    for (int k = 1; k <= h_; ++k)
      definite_ = definite_ && stages_[k].E.llt().info() == Eigen::Success;
    make_explicit();
    create();
    for (int k = 0; k <= h_; ++k) pack(k);
  }

  [[nodiscard]] bool solve() override {
    make_explicit();
    const double begin = threads::thread_cpu_s();
    d_ocp_qp_fact_solve_kkt_unconstr(&qp_, &solution_, &options_, &workspace_);
    own_s_ += threads::thread_cpu_s() - begin;
    return true;
  }
  double own_cpu_s() const override { return own_s_; }
  void read(StageStep<double>& step) const override;

 private:
  // At the end of the last sub-step nothing depends on the poses before it.
  int states(int k) const { return inertial_ && k > 0 && k < h_ ? 2 * kPoses : kPoses; }
  void make_explicit();
  void create();
  void pack(int k);
  void* memory(std::size_t size) { return memory_.emplace_back(size).data(); }

  int h_;  // sub-steps
  bool inertial_ = false;
  bool definite_ = true;  // all E_k are
  double own_s_ = 0.0;
  std::vector<DenseStage> stages_;
  std::vector<ExplicitStage> explicit_;
  std::vector<Memory> memory_;
  d_ocp_qp_dim sizes_;
  d_ocp_qp qp_;
  d_ocp_qp_sol solution_;
  d_ocp_qp_ipm_arg options_;
  d_ocp_qp_ipm_ws workspace_;
};

void HpipmPeer::make_explicit() {
  for (int k = 1; k <= h_; ++k) {
    const DenseStage& stage = stages_[k];
    if (definite_)
      explicit_[k].set(stage, stage.E.llt());
    else
      explicit_[k].set(stage, stage.E.partialPivLu());
  }
}

void HpipmPeer::create() {
  d_ocp_qp_dim_create(h_, &sizes_, memory(d_ocp_qp_dim_memsize(h_)));
  for (int k = 0; k <= h_; ++k) {
    d_ocp_qp_dim_set_nx(k, states(k), &sizes_);
    d_ocp_qp_dim_set_nu(k, k < h_ ? 3 : 0, &sizes_);
    for (const auto set_none :
         {d_ocp_qp_dim_set_nbx, d_ocp_qp_dim_set_nbu, d_ocp_qp_dim_set_ng, d_ocp_qp_dim_set_ns})
      set_none(k, 0, &sizes_);
  }
  d_ocp_qp_create(&sizes_, &qp_, memory(d_ocp_qp_memsize(&sizes_)));
  d_ocp_qp_set_all_zero(&qp_);
  d_ocp_qp_sol_create(&sizes_, &solution_, memory(d_ocp_qp_sol_memsize(&sizes_)));
  d_ocp_qp_ipm_arg_create(&sizes_, &options_, memory(d_ocp_qp_ipm_arg_memsize(&sizes_)));
  d_ocp_qp_ipm_arg_set_default(SPEED, &options_);
  int classical = 0;  // the square-root form wants every state's objective convex
  d_ocp_qp_ipm_arg_set_ric_alg(&classical, &options_);
  d_ocp_qp_ipm_ws_create(&sizes_, &options_, &workspace_,
                         memory(d_ocp_qp_ipm_ws_memsize(&sizes_, &options_)));
}

/// Copies sub-step k into HPIPM's own format.
void HpipmPeer::pack(int k) {
  MatrixXd Q = MatrixXd::Zero(states(k), states(k));
  VectorXd q = VectorXd::Zero(states(k));
  Q.topLeftCorner<kPoses, kPoses>() = stages_[k].Q;
  q.head<kPoses>() = stages_[k].q;
  if (k < h_) {
    ExplicitStage& next = explicit_[k + 1];
    const int rows = states(k + 1);
    MatrixXd A = MatrixXd::Zero(rows, states(k)), B = MatrixXd::Zero(rows, 3);
    VectorXd b = VectorXd::Zero(rows);
    A.topRows<kPoses>() = next.A;
    B.topRows<kPoses>() = next.B;
    b.head<kPoses>() = next.b;
    if (rows > kPoses) A.bottomLeftCorner<kPoses, kPoses>().setIdentity();
    Q += next.Q + next.Q.transpose();
    q += next.q;
    d_ocp_qp_set_A(k, A.data(), &qp_);
    d_ocp_qp_set_B(k, B.data(), &qp_);
    d_ocp_qp_set_b(k, b.data(), &qp_);
    d_ocp_qp_set_S(k, next.S.data(), &qp_);
    d_ocp_qp_set_R(k, stages_[k + 1].R.data(), &qp_);
    d_ocp_qp_set_r(k, stages_[k + 1].r.data(), &qp_);
  }
  d_ocp_qp_set_Q(k, Q.data(), &qp_);
  d_ocp_qp_set_q(k, q.data(), &qp_);
}

/// Finds the multipliers by stationarity in Δp_k, from the last sub-step to the first; see
/// Riccati.
void HpipmPeer::read(StageStep<double>& step) const {
  auto* solution = const_cast<d_ocp_qp_sol*>(&solution_);
  std::vector<VectorXd> x;
  for (int k = 0; k <= h_; ++k) {
    x.emplace_back(states(k));
    d_ocp_qp_sol_get_x(k, solution, x[k].data());
    Eigen::Map<Poses>(step.poses[k][0].data()) = x[k].head<kPoses>();
    if (k > 0) d_ocp_qp_sol_get_u(k - 1, solution, step.controls[k].data());
  }
  std::vector<Poses> y(stages_.size());
  for (int k = h_; k > 0; --k) {
    const DenseStage& stage = stages_[k];
    Poses sum = stage.Q * x[k].head<kPoses>() + stage.q + stage.NU * x[k - 1].head(stage.NU.cols());
    for (int m = k + 1; m <= std::min(k + (inertial_ ? 2 : 1), h_); ++m) {
      const DenseStage& later = stages_[m];
      sum += later.NU.middleCols<kPoses>((m - k - 1) * kPoses).transpose() * x[m].head<kPoses>();
      sum += later.FG.middleCols<kPoses>((m - k - 1) * kPoses).transpose() * y[m];
    }
    y[k] = -stage.E.partialPivLu().solve(sum);
    Eigen::Map<Poses>(step.multipliers[k][0].data()) = y[k];
  }
}

}  // namespace

std::unique_ptr<KktPeer> hpipm_peer(const StageSystem<double>& system) {
  return std::make_unique<HpipmPeer>(system);
}

}  // namespace rtg::bench
