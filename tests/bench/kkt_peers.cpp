#include "tests/bench/kkt_peers.hpp"

#include <klu.h>

#include <stdexcept>

#include "core/math/assembled_solver.hpp"

namespace rtg::bench {
namespace {

class CyclicReductionPeer final : public KktPeer {
 public:
  explicit CyclicReductionPeer(const StageSystem<double>& system)
      : assembled_(system, false), solver_(make_kkt_solver(KktMethod::kCyclicReduction)) {}

  [[nodiscard]] bool solve() override {
    if (!solver_->factorize(assembled_.matrix())) return false;
    x_ = solver_->solve(assembled_.right_hand_side());
    return true;
  }
  void read(StageStep<double>& step) const override { assembled_.read(x_, step); }

 private:
  Assembled assembled_;
  std::unique_ptr<KktSolver> solver_;
  BlockVector x_;
};

/// A factorisation by KLU, in the band order of the unknowns or in AMD's.
class Klu {
 public:
  Klu(Eigen::SparseMatrix<double>& K, bool band) : K_(K) {
    klu_defaults(&common_);
    common_.btf = 0;  // the matrix is one block
    const int n = static_cast<int>(K.cols());
    symbolic_ = band ? klu_analyze_given(n, K.outerIndexPtr(), K.innerIndexPtr(), nullptr, nullptr,
                                         &common_)
                     : klu_analyze(n, K.outerIndexPtr(), K.innerIndexPtr(), &common_);
    if (symbolic_)
      numeric_ =
          klu_factor(K.outerIndexPtr(), K.innerIndexPtr(), K.valuePtr(), symbolic_, &common_);
    if (!numeric_) throw std::logic_error("KLU cannot factorise the system");
  }
  ~Klu() {
    klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }
  Klu(const Klu&) = delete;
  Klu& operator=(const Klu&) = delete;

  int entries() const { return numeric_->lnz + numeric_->unz; }
  [[nodiscard]] bool refactorise() {
    return klu_refactor(K_.outerIndexPtr(), K_.innerIndexPtr(), K_.valuePtr(), symbolic_, numeric_,
                        &common_) != 0;
  }
  /// x ← K⁻¹ x.
  [[nodiscard]] bool solve(VectorXd& x) {
    return klu_solve(symbolic_, numeric_, static_cast<int>(x.size()), 1, x.data(), &common_) != 0;
  }

 private:
  Eigen::SparseMatrix<double>& K_;
  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

class KluPeer final : public KktPeer {
 public:
  explicit KluPeer(const StageSystem<double>& system)
      : assembled_(system, false),
        K_(sparse(assembled_.matrix())),
        r_(joined(assembled_.right_hand_side())),
        klu_(std::make_unique<Klu>(K_, true)) {
    auto by_amd = std::make_unique<Klu>(K_, false);
    if (by_amd->entries() < klu_->entries()) klu_ = std::move(by_amd);
  }

  [[nodiscard]] bool solve() override {
    x_ = r_;
    return klu_->refactorise() && klu_->solve(x_);
  }
  void read(StageStep<double>& step) const override {
    assembled_.read(split_like(assembled_.matrix(), x_), step);
  }

 private:
  Assembled assembled_;
  Eigen::SparseMatrix<double> K_;
  VectorXd r_, x_;
  std::unique_ptr<Klu> klu_;
};

}  // namespace

std::unique_ptr<KktPeer> cyclic_reduction_peer(const StageSystem<double>& system) {
  return std::make_unique<CyclicReductionPeer>(system);
}

std::unique_ptr<KktPeer> klu_peer(const StageSystem<double>& system) {
  return std::make_unique<KluPeer>(system);
}

}  // namespace rtg::bench
