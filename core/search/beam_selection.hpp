#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/search/search_config.hpp"

namespace rtg::search {

/// The figures by which the next beam is chosen, of a candidate.
struct BeamEntry {
  double score = 0.0;        // the less the better
  std::uint64_t cell = 0;    // StateMetric::cell(); candidates of one cell count as the same
  std::uint64_t layout = 0;  // StateMetric::layout_cell()
  bool contact = false;      // its push moved an object
};

/// Indices of the next beam, at most `times` config.breadth, in order of (score, index): first the
/// best of the contact quota, then the best of all. At most one per cell, none of a cell in `seen`,
/// at most `times` config.per_layout per layout; the chosen cells are added to `seen`. A pure
/// function of the complete set, so the order in which results arrived cannot matter.
std::vector<std::size_t> select_beam(std::span<const BeamEntry> entries, const SearchConfig& config,
                                     std::unordered_set<std::uint64_t>& seen, int times = 1);

}  // namespace rtg::search
