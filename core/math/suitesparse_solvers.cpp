#include <klu.h>
#include <umfpack.h>

#include <stdexcept>

#include "core/math/kkt_solvers.hpp"

namespace rtg {
namespace {

class Umfpack final : public KktSolver {
 public:
  ~Umfpack() override { clear(); }

  [[nodiscard]] bool factorize(const BlockTridiagonal& K) override {
    clear();
    shape_ = K;
    K_ = sparse(K);
    const int n = static_cast<int>(K_.cols());
    double control[UMFPACK_CONTROL], info[UMFPACK_INFO];
    umfpack_di_defaults(control);
    // Keeps the band order of the unknowns, in which fill-in grows linearly with the number of
    // blocks. In an AMD ordering it grows quadratically.
    control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control[UMFPACK_ORDERING] = UMFPACK_ORDERING_NONE;
    void* symbolic = nullptr;
    const int analysed = umfpack_di_symbolic(n, n, K_.outerIndexPtr(), K_.innerIndexPtr(),
                                             K_.valuePtr(), &symbolic, control, nullptr);
    if (analysed != UMFPACK_OK) return false;
    const int done = umfpack_di_numeric(K_.outerIndexPtr(), K_.innerIndexPtr(), K_.valuePtr(),
                                        symbolic, &numeric_, control, info);
    umfpack_di_free_symbolic(&symbolic);
    return done == UMFPACK_OK && info[UMFPACK_RCOND] > kLeastPivotRatio;
  }

  [[nodiscard]] BlockVector solve(const BlockVector& r) const override {
    const VectorXd rhs = joined(r);
    VectorXd x(rhs.size());
    const int done =
        umfpack_di_solve(UMFPACK_A, K_.outerIndexPtr(), K_.innerIndexPtr(), K_.valuePtr(), x.data(),
                         rhs.data(), numeric_, nullptr, nullptr);
    if (done != UMFPACK_OK) throw std::logic_error("UMFPACK solve without a factorisation");
    return split_like(shape_, x);
  }

 private:
  void clear() {
    if (numeric_) umfpack_di_free_numeric(&numeric_);
    numeric_ = nullptr;
  }

  BlockTridiagonal shape_;
  Eigen::SparseMatrix<double> K_;
  void* numeric_ = nullptr;
};

class Klu final : public KktSolver {
 public:
  Klu() {
    klu_defaults(&common_);
    common_.btf = 0;  // the matrix is one block
  }
  ~Klu() override { clear(); }

  [[nodiscard]] bool factorize(const BlockTridiagonal& K) override {
    clear();
    shape_ = K;
    Eigen::SparseMatrix<double> S = sparse(K);
    if (!S.coeffs().allFinite()) return false;
    const int n = static_cast<int>(S.cols());
    // Keeps the band order of the unknowns, for the same reason as Umfpack.
    symbolic_ =
        klu_analyze_given(n, S.outerIndexPtr(), S.innerIndexPtr(), nullptr, nullptr, &common_);
    if (!symbolic_) return false;
    numeric_ = klu_factor(S.outerIndexPtr(), S.innerIndexPtr(), S.valuePtr(), symbolic_, &common_);
    return numeric_ && common_.status == KLU_OK && klu_rcond(symbolic_, numeric_, &common_) &&
           common_.rcond > kLeastPivotRatio;
  }

  [[nodiscard]] BlockVector solve(const BlockVector& r) const override {
    if (!numeric_) throw std::logic_error("KLU solve without a factorisation");
    VectorXd x = joined(r);
    klu_common common = common_;
    klu_solve(symbolic_, numeric_, static_cast<int>(x.size()), 1, x.data(), &common);
    return split_like(shape_, x);
  }

 private:
  void clear() {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }

  BlockTridiagonal shape_;
  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<KktSolver> make_kkt_solver(KktMethod method) {
  switch (method) {
    case KktMethod::kCyclicReduction:
      return std::make_unique<CyclicReduction>();
    case KktMethod::kUmfpack:
      return std::make_unique<Umfpack>();
    case KktMethod::kKlu:
      return std::make_unique<Klu>();
    case KktMethod::kBlockElimination:
      break;
  }
  return std::make_unique<BlockElimination>();
}

}  // namespace rtg
