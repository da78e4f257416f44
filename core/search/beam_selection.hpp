#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

namespace rtg::search {

/// A candidate for the next beam, as select_beam() sees it.
struct BeamEntry {
  double score = 0.0;      // lower is better
  std::uint64_t cell = 0;  // StateMetric::cell(); equal cells: the same state
};

/// Selects the next beam and returns its indices in `entries`, best score first:
///
///  1. Keep the best entry of each cell. Drop entries whose cell is in `seen`.
///  2. Keep the best `count` of the rest. Add their cells to `seen`.
///
/// Of equal scores, the lower index is better.
std::vector<std::size_t> select_beam(std::span<const BeamEntry> entries, int count,
                                     std::unordered_set<std::uint64_t>& seen);

}  // namespace rtg::search
