#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "core/math/block_tridiagonal.hpp"

namespace rtg {

enum class KktMethod { kBlockElimination, kCyclicReduction, kUmfpack, kKlu };
inline constexpr std::array<std::string_view, 4> kKktMethods{"block_elimination",
                                                             "cyclic_reduction", "umfpack", "klu"};

/// Direct solver of symmetric indefinite block-tridiagonal systems K x = r. Factorises K once and
/// solves for several right-hand sides.
class KktSolver {
 public:
  virtual ~KktSolver() = default;

  /// Returns false if K is singular or not finite; solve() must then not be called.
  [[nodiscard]] virtual bool factorize(const BlockTridiagonal& K) = 0;
  [[nodiscard]] virtual BlockVector solve(const BlockVector& r) const = 0;
};

/// Returns a solver for N blocks:
///
/// - block elimination, from the last block to the first, O(N). The last block is the KKT matrix of
///   a whole sub-step and regular; the first block alone is singular;
/// - cyclic reduction [Hockney 1965], the paper's A.3. It eliminates every second block and takes
///   O(N) work in O(log N) successive reductions;
/// - SuiteSparse's UMFPACK [Davis 2004] and KLU [Davis 2010], on the assembled sparse matrix. They
///   are the references that the other methods are compared with.
std::unique_ptr<KktSolver> make_kkt_solver(KktMethod method);

}  // namespace rtg
