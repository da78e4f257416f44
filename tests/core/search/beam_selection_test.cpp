#include "core/search/beam_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/math/rng.hpp"

namespace rtg::search {
namespace {

using Cells = std::unordered_set<std::uint64_t>;
using Indices = std::vector<std::size_t>;

/// `count` entries, each in a cell of its own, scores 0, 1, 2, ...
std::vector<BeamEntry> ranked(int count) {
  std::vector<BeamEntry> entries;
  for (int k = 0; k < count; ++k)
    entries.push_back({static_cast<double>(k), static_cast<std::uint64_t>(1000 + k)});
  return entries;
}

Indices select(const std::vector<BeamEntry>& entries, int count, Cells seen = {}) {
  return select_beam(entries, count, seen);
}

/// Entries as a search meets them: some share a cell.
std::vector<BeamEntry> random_entries(Rng& rng, int count) {
  std::vector<BeamEntry> entries;
  for (int k = 0; k < count; ++k) {
    const auto cell = static_cast<std::uint64_t>(rng.below(160));
    entries.push_back({rng.uniform(0.0, 1.0), cell});
  }
  return entries;
}

TEST(BeamSelection, TakesTheBest) {
  std::vector<BeamEntry> entries = ranked(9);
  std::ranges::reverse(entries);
  EXPECT_EQ(select(entries, 4), (Indices{8, 7, 6, 5}));
}

TEST(BeamSelection, TakesAllIfThereAreFewer) {
  EXPECT_EQ(select(ranked(3), 10), (Indices{0, 1, 2}));
  EXPECT_EQ(select({}, 10), Indices{});
}

TEST(BeamSelection, KeepsTheBestOfEachCell) {
  std::vector<BeamEntry> entries = ranked(6);
  entries[1].cell = entries[0].cell;
  entries[4].cell = entries[0].cell;
  entries[5].cell = entries[3].cell;
  EXPECT_EQ(select(entries, 10), (Indices{0, 2, 3}));
}

TEST(BeamSelection, OfEqualScoresInACellTheFirstStays) {
  std::vector<BeamEntry> entries = ranked(3);
  for (BeamEntry& e : entries) e = {1.0, 7};
  EXPECT_EQ(select(entries, 10), Indices{0});
}

TEST(BeamSelection, NeverEntersACellTwiceAndNotesOnlyWhatItChose) {
  const std::vector<BeamEntry> entries = ranked(9);
  Cells seen{entries[1].cell};
  EXPECT_EQ(select_beam(entries, 3, seen), (Indices{0, 2, 3}));
  EXPECT_EQ(seen, (Cells{entries[0].cell, entries[1].cell, entries[2].cell, entries[3].cell}));
  EXPECT_EQ(select_beam(entries, 3, seen), (Indices{4, 5, 6}));
  EXPECT_EQ(select_beam(entries, 3, seen), (Indices{7, 8}));
  EXPECT_EQ(select_beam(entries, 3, seen), Indices{});
}

TEST(BeamSelection, HoldsAllItsPromisesOnRandomLayers) {
  Rng rng(21);
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<BeamEntry> entries = random_entries(rng, 300);
    Cells seen{3, 17, 80}, before = seen;
    const Indices beam = select_beam(entries, 20, seen);
    ASSERT_EQ(beam.size(), 20U);
    std::set<std::uint64_t> cells;
    for (const std::size_t k : beam) {
      ASSERT_TRUE(cells.insert(entries[k].cell).second);
      ASSERT_FALSE(before.contains(entries[k].cell));
    }
    ASSERT_TRUE(std::ranges::is_sorted(beam, {}, [&](std::size_t k) { return entries[k].score; }));
    before.insert(cells.begin(), cells.end());
    ASSERT_EQ(seen, before);
  }
}

TEST(BeamSelection, DoesNotDependOnTheOrderInWhichResultsArrived) {
  Rng rng(22);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<BeamEntry> entries = random_entries(rng, 200);
    const auto cells = [&entries] {
      std::vector<std::uint64_t> out;
      for (const std::size_t k : select(entries, 20, {5, 6})) out.push_back(entries[k].cell);
      return out;
    };
    const std::vector<std::uint64_t> first = cells();
    for (std::size_t k = entries.size() - 1; k > 0; --k)
      std::swap(entries[k], entries[static_cast<std::size_t>(rng.below(static_cast<int>(k) + 1))]);
    ASSERT_EQ(cells(), first);
  }
}

}  // namespace
}  // namespace rtg::search
