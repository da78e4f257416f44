#include "core/search/beam_selection.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace rtg::search {

std::vector<std::size_t> select_beam(std::span<const BeamEntry> entries, const BeamLimits& limits,
                                     std::unordered_set<std::uint64_t>& seen) {
  std::vector<std::size_t> beam(entries.size());
  std::iota(beam.begin(), beam.end(), std::size_t{0});
  std::ranges::stable_sort(beam, {}, [&](std::size_t k) { return entries[k].score; });
  std::unordered_map<std::uint64_t, int> layouts;
  int left = limits.nodes;
  std::erase_if(beam, [&](std::size_t k) {
    int& alike = layouts[entries[k].layout];
    if (left == 0 || alike == limits.nodes_per_layout) return true;
    if (!seen.insert(entries[k].cell).second) return true;
    ++alike;
    --left;
    return false;
  });
  return beam;
}

}  // namespace rtg::search
