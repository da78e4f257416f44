#include "core/search/beam_selection.hpp"

#include <algorithm>
#include <numeric>

namespace rtg::search {

std::vector<std::size_t> select_beam(std::span<const BeamEntry> entries, int count,
                                     std::unordered_set<std::uint64_t>& seen) {
  std::vector<std::size_t> beam(entries.size());
  std::iota(beam.begin(), beam.end(), std::size_t{0});
  std::ranges::stable_sort(beam, {}, [&](std::size_t k) { return entries[k].score; });
  std::erase_if(beam, [&](std::size_t k) {
    if (count == 0 || !seen.insert(entries[k].cell).second) return true;
    --count;
    return false;
  });
  return beam;
}

}  // namespace rtg::search
