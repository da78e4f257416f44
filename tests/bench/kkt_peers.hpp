#pragma once

#include <memory>

#include "core/math/stage_system.hpp"

namespace rtg::bench {

inline constexpr int kBodies = 6;

/// A solver of one StageSystem, one problem at a time, that our recursion is compared with.
/// Assembly, ordering, symbolic analysis and copies into the peer's own formats are done in its
/// constructor, which is not timed.
class KktPeer {
 public:
  virtual ~KktPeer() = default;

  /// Factorises and solves. Returns false if the system is singular.
  [[nodiscard]] virtual bool solve() = 0;
  /// CPU time so far of the part of solve() that is the peer's library, where it is not all [s].
  virtual double own_cpu_s() const { return 0.0; }
  /// Writes what solve() found.
  virtual void read(StageStep<double>& step) const = 0;
};

/// The paper's cyclic reduction of the assembled system.
std::unique_ptr<KktPeer> cyclic_reduction_peer(const StageSystem<double>& system);
/// KLU on the assembled system, analysed once in the order of two that fills fewer entries; solve()
/// factorises with the pivots of the first factorisation.
std::unique_ptr<KktPeer> klu_peer(const StageSystem<double>& system);
#ifdef RTG_HPIPM
/// The Riccati recursion of HPIPM, for kBodies bodies. It takes explicit dynamics of dense states:
/// solve() multiplies by E⁻¹, substitutes the dynamics in the terms of N and U, and then calls
/// HPIPM's factorisation. With inertia a state holds the poses of two sub-steps. HPIPM's
/// multipliers are those of other constraints; read() works out ours.
std::unique_ptr<KktPeer> hpipm_peer(const StageSystem<double>& system);
#endif

}  // namespace rtg::bench
