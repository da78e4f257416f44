#include "core/search/beam_selection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace rtg::search {
namespace {

/// Returns the indices of distinct entries, best first. Keeps the best entry of each cell that is
/// not in `seen`, and at most `nodes_per_layout` entries of each layout.
std::vector<std::size_t> distinct(std::span<const BeamEntry> entries, int nodes_per_layout,
                                  std::unordered_set<std::uint64_t> seen) {
  std::vector<std::size_t> order(entries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return entries[a].score < entries[b].score;
  });
  std::unordered_map<std::uint64_t, int> layouts;
  std::erase_if(order, [&](std::size_t k) {
    int& alike = layouts[entries[k].layout];
    if (alike == nodes_per_layout || !seen.insert(entries[k].cell).second) return true;
    ++alike;
    return false;
  });
  return order;
}

/// Moves the first `count` elements of `from` that satisfy `wanted` to the end of `to`.
template <class Wanted>
void take(std::vector<std::size_t>& from, std::vector<std::size_t>& to, int count, Wanted wanted) {
  std::erase_if(from, [&](std::size_t k) {
    if (count <= 0 || !wanted(k)) return false;
    to.push_back(k);
    --count;
    return true;
  });
}

}  // namespace

std::vector<std::size_t> select_beam(std::span<const BeamEntry> entries, const SearchConfig& config,
                                     std::unordered_set<std::uint64_t>& seen, int times) {
  std::vector<std::size_t> rest = distinct(entries, times * config.nodes_per_layout, seen), beam;
  const int breadth = times * config.breadth;
  const auto quota = static_cast<int>(std::lround(config.contact_quota * breadth));
  take(rest, beam, quota, [&](std::size_t k) { return entries[k].contact; });
  take(rest, beam, breadth - static_cast<int>(beam.size()), [](std::size_t) { return true; });
  std::sort(beam.begin(), beam.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(entries[a].score, a) < std::pair(entries[b].score, b);
  });
  for (const std::size_t k : beam) seen.insert(entries[k].cell);
  return beam;
}

}  // namespace rtg::search
