#include "nodes/stream/stream_cursor.hpp"

#include <gtest/gtest.h>

#include <string>

namespace rtg::stream {
namespace {

using Cursor = StreamCursor<std::string>;
using Pieces = std::vector<Cursor::Piece>;
using Ranges = std::vector<RowRange>;
using Ack = Acknowledgement;

Cursor cursor_with(std::int64_t credit) {
  Cursor::Limits limits;
  limits.credit = credit;
  return Cursor(limits);
}

TEST(StreamCursor, AGoodNetworkNeedsNoQuestion) {
  Cursor cursor = cursor_with(100);
  for (const int first : {0, 10, 20})
    EXPECT_EQ(cursor.on_rows({first, first + 10}, "a", 0.1 * first), (Pieces{{"a", 0}}));
  cursor.on_tail(30, true);
  EXPECT_TRUE(cursor.complete());
}

TEST(StreamCursor, WhoHasAllOfASealedStreamSaysSoManyTimesAndGoesOnSayingIt) {
  Cursor cursor = cursor_with(100);
  cursor.on_rows({0, 10}, "a", 0.0);
  cursor.on_tail(10, false);
  EXPECT_EQ(cursor.due(1.0), (Ack{10, 100, {}})) << "not sealed yet";
  cursor.on_tail(10, true);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(cursor.due(1.0), (Ack{10, 0, {}}));
  EXPECT_EQ(cursor.due(1.1), std::nullopt);
  EXPECT_EQ(cursor.due(1.6), (Ack{10, 0, {}}));
}

TEST(StreamCursor, AGapIsAskedForAtOnceAndAgainAfterAWhile) {
  Cursor cursor = cursor_with(100);
  EXPECT_EQ(cursor.on_rows({10, 20}, "b", 0.0), Pieces{});
  EXPECT_EQ(cursor.due(0.0), (Ack{0, 100, {{0, 10}}}));
  EXPECT_EQ(cursor.due(0.05), std::nullopt);
  EXPECT_EQ(cursor.due(0.11), (Ack{0, 100, {{0, 10}}}));
  EXPECT_EQ(cursor.on_rows({0, 10}, "a", 0.12), (Pieces{{"a", 0}, {"b", 0}}));
  EXPECT_EQ(cursor.cursor(), 20);
}

TEST(StreamCursor, LostLastRowsAreSeenByTheTail) {
  Cursor cursor = cursor_with(100);
  cursor.on_tail(7, true);
  EXPECT_FALSE(cursor.complete());
  EXPECT_EQ(cursor.due(1.0), (Ack{0, 100, {{0, 7}}}));
}

TEST(StreamCursor, RowsBeyondTheCreditAreNeitherHeldNorForgotten) {
  Cursor cursor = cursor_with(20);
  EXPECT_EQ(cursor.on_rows({30, 40}, "far", 0.0), Pieces{});
  EXPECT_EQ(cursor.due(1.0), (Ack{0, 20, {{0, 20}}}));
}

TEST(StreamCursor, AGapBeginsAfterTheLongestOfOverlappingPieces) {
  Cursor cursor = cursor_with(100);
  cursor.on_rows({10, 30}, "long", 0.0);
  cursor.on_rows({12, 15}, "within", 0.0);
  cursor.on_tail(40, false);
  EXPECT_EQ(cursor.due(1.0), (Ack{0, 100, {{0, 10}, {30, 40}}}));
}

TEST(StreamCursor, OverlappingPiecesAreCut) {
  Cursor cursor = cursor_with(100);
  EXPECT_EQ(cursor.on_rows({5, 15}, "late", 0.0), Pieces{});
  EXPECT_EQ(cursor.on_rows({0, 8}, "early", 0.0), (Pieces{{"early", 0}, {"late", 3}}));
  EXPECT_EQ(cursor.on_rows({0, 15}, "again", 0.0), Pieces{});
}

TEST(StreamCursor, AsksForABoundedNumberOfRanges) {
  Cursor cursor = cursor_with(1000);
  for (int first = 1; first < 200; first += 2) cursor.on_rows({first, first + 1}, "a", 0.0);
  EXPECT_EQ(cursor.due(1.0)->missing.size(), 32U);
}

}  // namespace
}  // namespace rtg::stream
