#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

namespace rtg::search {

/// A candidate for the next beam, as select_beam() sees it.
struct BeamEntry {
  double score = 0.0;        // lower is better
  std::uint64_t cell = 0;    // StateMetric::cell(); equal cells: the same state
  std::uint64_t layout = 0;  // StateMetric::layout_cell(); equal: all objects lie alike
};

/// Largest numbers of nodes of a beam.
struct BeamLimits {
  int nodes;             // in all
  int nodes_per_layout;  // that differ only in the robot's position
};

/// Selects the next beam and returns its indices in `entries`, best score first:
///
///  1. Keep the best entry of each cell. Drop entries whose cell is in `seen`.
///  2. Keep the best limits.nodes_per_layout entries of each layout.
///  3. Keep the best limits.nodes of the rest. Add their cells to `seen`.
///
/// Of equal scores, the lower index is better.
std::vector<std::size_t> select_beam(std::span<const BeamEntry> entries, const BeamLimits& limits,
                                     std::unordered_set<std::uint64_t>& seen);

}  // namespace rtg::search
