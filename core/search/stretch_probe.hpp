#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/rng.hpp"
#include "core/search/forward_replay.hpp"
#include "core/search/search_config.hpp"
#include "core/search/state_metric.hpp"

namespace rtg {

/// Finds out how pushes pass errors on: a push is replayed from disturbed twins s_t of its start s,
/// which end in e_t instead of e;
///
///   stretch = Σ_t |e_t - e| / Σ_t |s_t - s|,   distances as in StateMetric.
///
/// About 1 where the robot pushes face to face or moves nothing; a corner that drags an object far
/// turns a small error into a large one. Twins are not stored.
class StretchProbe {
 public:
  /// The task must outlive the probe.
  StretchProbe(const Task& task, const SearchConfig& config, std::uint64_t seed);

  /// Fills in `stretch` of the replayed candidates that move an object and miss by no more than
  /// config.gap_tolerance. Draws config.twins twins each, bodies moved by up to
  /// ± config.twin_jitter in x and y, objects turned by as much [m, rad]; fixed ones stay.
  void measure(std::span<Candidate> candidates, const ReplayBatch& replay, SearchStats& stats);

 private:
  struct Twin {
    std::size_t of;  // index of its candidate
    Poses start;
  };
  std::vector<Twin> draw(std::span<const Candidate> candidates);
  Poses disturbed(Poses poses);

  const Task& task_;
  SearchConfig config_;
  StateMetric metric_;
  Rng rng_;
};

}  // namespace rtg
