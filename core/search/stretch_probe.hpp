#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/rng.hpp"
#include "core/search/forward_replay.hpp"
#include "core/search/search_config.hpp"
#include "core/search/state_metric.hpp"

namespace rtg {

/// Whether a plan may go through the push: neither does it turn an object far, as a corner does,
/// nor stretch errors, by more than the tolerances of the config.
bool repeatable(const Predecessor& push, const SearchConfig& config);

/// Finds out how pushes pass errors on: a push is replayed from disturbed twins s_t of its start s,
/// which end in e_t instead of e;
///
///   stretch = Σ_t |e_t - e| / Σ_t |s_t - s|,   distances as in StateMetric.
///
/// About 1 where the robot meets nothing or pushes face to face, but not far; it grows where a
/// corner pushes, where the robot brushes past an object that a twin hits, and with the way that it
/// pushes. Twins are not stored.
class StretchProbe {
 public:
  /// The task must outlive the probe.
  StretchProbe(const Task& task, const SearchConfig& config, std::uint64_t seed);

  /// Fills in `stretch` of the replayed candidates that a plan may go through: they turn no object
  /// by more than config.turn_tolerance, and miss by no more than config.gap_tolerance or reach the
  /// goal. Each gets config.twins twins, bodies moved by up to ± config.twin_jitter in x and y,
  /// objects turned by up to 2/3 rad per metre of it; of bodies that joints connect the
  /// root is moved and each turned by its share of that, within limits; fixed bodies stay. Without
  /// a legal twin that the simulator finishes it stays 1.
  void measure(std::span<Predecessor> candidates, const ReplayBatch& replay, SearchStats& stats);

 private:
  struct Twin {
    std::size_t of;  // index of its candidate
    Poses start;
  };
  std::vector<Twin> draw(std::span<const Predecessor> candidates);
  Poses disturbed(Poses poses);

  const Task& task_;
  SearchConfig config_;
  StateMetric metric_;
  std::vector<std::size_t> movers_;  // as movers_of()
  Rng rng_;
};

}  // namespace rtg
