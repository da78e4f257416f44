#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "core/math/block_tridiagonal.hpp"

namespace rtg {

/// Methods for the KKT systems of the SQP. kBlockElimination stands for two: the Riccati recursion
/// (Riccati) in the filter SQP (preset `default`) if the final state is not fixed, otherwise block
/// elimination of the assembled system (make_kkt_solver()). See solve_together().
enum class KktMethod { kBlockElimination, kCyclicReduction, kUmfpack, kKlu };
inline constexpr std::array<std::string_view, 4> kKktMethods{"block_elimination",
                                                             "cyclic_reduction", "umfpack", "klu"};

/// Direct solver of symmetric indefinite block-tridiagonal systems K x = r. K is factorised once
/// for several right-hand sides.
class KktSolver {
 public:
  virtual ~KktSolver() = default;

  /// Factorises K. Returns false if K is singular or not finite; then solve() must not be called.
  [[nodiscard]] virtual bool factorize(const BlockTridiagonal& K) = 0;
  [[nodiscard]] virtual BlockVector solve(const BlockVector& r) const = 0;
};

/// Returns a solver by one of these methods, for N blocks:
///
/// - block elimination from the last block to the first, O(N). This order suits both pairings of
///   Assembled. In the centred one the last block is the KKT matrix of a whole sub-step, regular
///   where its E is; the first block, Δp_0 alone, may be singular. In the other one every block is
///   such a matrix, regular where its F is, but for a last block Δp_h, which has the spring to the
///   final state;
/// - cyclic reduction [Hockney 1965], the paper's A.3. Each of O(log N) successive reductions
///   eliminates every second block; the total work is O(N);
/// - SuiteSparse's UMFPACK [Davis 2004] or KLU [Davis 2010] on the assembled sparse matrix. They
///   are the references that the other methods are compared with.
std::unique_ptr<KktSolver> make_kkt_solver(KktMethod method);

}  // namespace rtg
