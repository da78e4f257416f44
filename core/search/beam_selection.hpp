#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/search/search_config.hpp"

namespace rtg::search {

/// A candidate for the next beam, as select_beam() sees it.
struct BeamEntry {
  double score = 0.0;        // lower is better
  std::uint64_t cell = 0;    // StateMetric::cell(); equal cells: the same state
  std::uint64_t layout = 0;  // StateMetric::layout_cell(); equal: all objects lie alike
};

/// Selects the next beam and returns its indices in `entries`, best score first:
///
///  1. Keep the best entry of each cell. Drop entries whose cell is in `seen`.
///  2. Keep the best `times` · config.nodes_per_layout entries of each layout.
///  3. Keep the best `times` · config.breadth of the rest. Add their cells to `seen`.
///
/// Of equal scores, the lower index is better.
std::vector<std::size_t> select_beam(std::span<const BeamEntry> entries, const SearchConfig& config,
                                     std::unordered_set<std::uint64_t>& seen, int times = 1);

}  // namespace rtg::search
