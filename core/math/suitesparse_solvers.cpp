#include <klu.h>
#include <umfpack.h>

#include <stdexcept>

#include "core/math/kkt_solvers.hpp"

namespace rtg {
namespace {

/// The nonzeros of K in compressed-column format.
struct SparseColumns {
  std::vector<int> start{0}, row;
  std::vector<double> value;
};

SparseColumns sparse(const BlockTridiagonal& K) {
  SparseColumns S;
  const auto append = [&S](const auto& column, Eigen::Index first) {
    for (Eigen::Index i = 0; i < column.size(); ++i) {
      if (column[i] == 0.0) continue;
      S.row.push_back(static_cast<int>(first + i));
      S.value.push_back(column[i]);
    }
  };
  Eigen::Index at = 0, before = 0;
  for (std::size_t k = 0; k < K.blocks(); ++k) {
    const Eigen::Index n = K.A[k].rows();
    for (Eigen::Index j = 0; j < n; ++j) {
      if (k > 0) append(K.B[k].row(j), before);
      append(K.A[k].col(j), at);
      if (k + 1 < K.blocks()) append(K.B[k + 1].col(j), at + n);
      S.start.push_back(static_cast<int>(S.row.size()));
    }
    before = at;
    at += n;
  }
  return S;
}

bool all_finite(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()))
      .allFinite();
}

class Umfpack final : public KktSolver {
 public:
  ~Umfpack() override { clear(); }

  [[nodiscard]] bool factorize(const BlockTridiagonal& K) override {
    clear();
    shape_ = K;
    columns_ = sparse(K);
    const int n = static_cast<int>(K.order());
    double control[UMFPACK_CONTROL], info[UMFPACK_INFO];
    umfpack_di_defaults(control);
    // Keeps the band order of the unknowns, in which fill-in grows linearly with the number of
    // blocks. In an AMD ordering it grows quadratically.
    control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control[UMFPACK_ORDERING] = UMFPACK_ORDERING_NONE;
    void* symbolic = nullptr;
    const int analysed = umfpack_di_symbolic(n, n, columns_.start.data(), columns_.row.data(),
                                             columns_.value.data(), &symbolic, control, nullptr);
    if (analysed != UMFPACK_OK) return false;
    const int done = umfpack_di_numeric(columns_.start.data(), columns_.row.data(),
                                        columns_.value.data(), symbolic, &numeric_, control, info);
    umfpack_di_free_symbolic(&symbolic);
    return done == UMFPACK_OK && info[UMFPACK_RCOND] > kLeastPivotRatio;
  }

  [[nodiscard]] BlockVector solve(const BlockVector& r) const override {
    const VectorXd rhs = joined(r);
    VectorXd x(rhs.size());
    const int done =
        umfpack_di_solve(UMFPACK_A, columns_.start.data(), columns_.row.data(),
                         columns_.value.data(), x.data(), rhs.data(), numeric_, nullptr, nullptr);
    if (done != UMFPACK_OK) throw std::logic_error("UMFPACK solve without a factorisation");
    return split_like(shape_, x);
  }

 private:
  void clear() {
    if (numeric_) umfpack_di_free_numeric(&numeric_);
    numeric_ = nullptr;
  }

  BlockTridiagonal shape_;
  SparseColumns columns_;
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
    SparseColumns S = sparse(K);
    if (!all_finite(S.value)) return false;
    const int n = static_cast<int>(K.order());
    // Keeps the band order of the unknowns, for the same reason as Umfpack.
    symbolic_ = klu_analyze_given(n, S.start.data(), S.row.data(), nullptr, nullptr, &common_);
    if (!symbolic_) return false;
    numeric_ = klu_factor(S.start.data(), S.row.data(), S.value.data(), symbolic_, &common_);
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
