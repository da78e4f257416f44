#include "nodes/beam_coordinator/row_digest.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rtg::beam_coordinator {
namespace {

TEST(RowDigest, IsThatOfPythonHoweverTheRowsAreDivided) {
  const std::vector<search::Transition> rows = {
      {{{0, 1, 2}, {3, 4, 5}}, 7, {{0.5, 1.5, 2.5}, {3.5, 4.5, 5.5}}},
      {{{6, 7, 8}, {9, 10, 11}},
       -1,
       {{6.5, 7.5, 8.5}, {9.5, 10.5, 11.5}},
       true,
       search::Source::kForward}};
  // As in tests/train/files/test_row_digest.py.
  const std::string known = "ebd427d999e3a719e0aec00709a23a16bcdb9d3f7e53dab123a71687d72a3542";
  RowDigest whole, parts;
  whole.add(rows);
  EXPECT_EQ(whole.hex(), known);
  for (const search::Transition& row : rows) parts.add({&row, 1});
  EXPECT_EQ(parts.hex(), known);
}

}  // namespace
}  // namespace rtg::beam_coordinator
