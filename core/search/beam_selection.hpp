#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/search/search_config.hpp"

namespace rtg::search {

/// Figures of a candidate by which the next beam is selected.
struct BeamEntry {
  double score = 0.0;        // lower is better
  std::uint64_t cell = 0;    // StateMetric::cell(); candidates of one cell count as the same
  std::uint64_t layout = 0;  // StateMetric::layout_cell()
  bool contact = false;      // its push moved an object
};

/// Returns the indices of the next beam, at most `times` · config.breadth, in (score, index) order.
/// First the contact quota is filled with the best entries that have `contact`, then the rest with
/// the best of all. There is at most one entry per cell, none of a cell in `seen`, and at most
/// `times` · config.nodes_per_layout per layout; the selected cells are added to `seen`. The
/// selection is a pure function of the complete set, so the order in which results arrived does not
/// matter.
std::vector<std::size_t> select_beam(std::span<const BeamEntry> entries, const SearchConfig& config,
                                     std::unordered_set<std::uint64_t>& seen, int times = 1);

}  // namespace rtg::search
