#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "core/math/block_tridiagonal.hpp"

namespace rtg {

enum class KktMethod { kBlockElimination, kCyclicReduction, kUmfpack, kKlu };
inline constexpr std::array<std::string_view, 4> kKktMethods{"block_elimination",
                                                             "cyclic_reduction", "umfpack", "klu"};

/// Direct solver of symmetric indefinite block-tridiagonal systems K x = r: factorised once, solved
/// for several right-hand sides.
class KktSolver {
 public:
  virtual ~KktSolver() = default;

  /// False if K is singular or not finite; solve() must then not be called.
  [[nodiscard]] virtual bool factorize(const BlockTridiagonal& K) = 0;
  [[nodiscard]] virtual BlockVector solve(const BlockVector& r) const = 0;
};

/// - block elimination: from the last block to the first, O(N); the pivot of the last block is a
///   whole sub-step's KKT matrix and regular, the first one's alone is not,
/// - cyclic reduction [Hockney 1965], the paper's A.3: every second block is eliminated, O(N) work,
///   O(log N) deep,
/// - SuiteSparse's UMFPACK [Davis 2004] and KLU [Davis 2010] on the assembled sparse matrix: the
///   oracles.
std::unique_ptr<KktSolver> make_kkt_solver(KktMethod method);

}  // namespace rtg
