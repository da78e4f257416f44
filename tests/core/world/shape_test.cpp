#include "core/world/shape.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/math/rng.hpp"
#include "core/world/outline.hpp"
#include "core/world/overlap.hpp"

namespace rtg {
namespace {

constexpr double kPi = std::numbers::pi;

/// A bar 4 x 1 with a stem 1 x 3 below: the T of Push-T.
std::vector<Part> letter_t() {
  return {placed({{box(4, 1)}}, 0.0, {0, 1.5})[0], placed({{box(1, 3)}}, 0.0, {0, -0.5})[0]};
}

std::vector<Part> cross() { return {{box(3, 1)}, {box(1, 3)}}; }

/// Whether a point of the body frame lies in the part.
bool contains(const Part& part, const Vector2d& x) {
  bool inside = part.core.size() > 2;
  for (std::size_t k = 0; k < part.core.size(); ++k) {
    const Vector2d &v = part.core.vertices[k], &w = part.core.vertices[(k + 1) % part.core.size()];
    const Vector2d edge = w - v, from = x - v;
    inside = inside && edge.x() * from.y() - edge.y() * from.x() >= 0.0;
    const double along = edge.dot(from) / std::max(edge.squaredNorm(), 1e-12);
    if ((from - std::clamp(along, 0.0, 1.0) * edge).norm() <= part.radius) return true;
  }
  return inside;
}

/// The moments by sampling, from which they differ by about 0.3 % of each.
Moments sampled(const std::vector<Part>& parts, double reach) {
  Rng rng(1);
  AreaIntegrals sum;
  constexpr int kSamples = 400000;
  for (int k = 0; k < kSamples; ++k) {
    const Vector2d x(rng.uniform(-reach, reach), rng.uniform(-reach, reach));
    const double cell = 4.0 * reach * reach / kSamples;
    if (std::ranges::any_of(parts, [&](const Part& part) { return contains(part, x); }))
      sum.add({cell, cell * x, cell * x.squaredNorm()});
  }
  return sum.moments();
}

TEST(Shape, OfADiscHasTheTextbookMoments) {
  const Shape shape(disc(0.7));
  EXPECT_NEAR(shape.moments().area, kPi * 0.49, 1e-15);
  EXPECT_NEAR(shape.moments().polar, kPi * std::pow(0.7, 4) / 2.0, 1e-15);
  EXPECT_LT(shape.moments().centroid.norm(), 1e-15);
  EXPECT_EQ(shape.radius(), 0.7);
}

TEST(Shape, MomentsAreThoseOfTheUnion) {
  const std::vector<std::vector<Part>> shapes{
      {{box(1.2, 0.8), 0.3}},
      {{regular_polygon(5, 0.9), 0.2}},
      {{Polygon{{{0, 0}, {1, 0}, {0.2, 0.7}}}, 0.25}},
      letter_t(),
      cross(),
      {{box(1, 1)}, {{{{0.5, 0.0}}}, 0.6}},
  };
  for (const std::vector<Part>& parts : shapes) {
    const Shape shape(parts);
    const Moments expected = sampled(parts, 2.6);
    EXPECT_NEAR(shape.moments().area, expected.area, 0.01 * expected.area);
    EXPECT_LT((shape.moments().centroid - expected.centroid).norm(), 0.01);
    EXPECT_NEAR(shape.moments().polar, expected.polar, 0.015 * expected.polar);
    EXPECT_LT(shape.centred().moments().centroid.norm(), 1e-10);
  }
}

TEST(Shape, OverlapsCountOnce) {
  EXPECT_NEAR(Shape(cross()).moments().area, 5.0, 1e-12);
  const Moments t = Shape(letter_t()).moments();
  EXPECT_NEAR(t.area, 7.0, 1e-12);
  EXPECT_NEAR(t.centroid.y(), (4.0 * 1.5 + 3.0 * -0.5) / 7.0, 1e-12);
}

std::size_t tips(const std::vector<Part>& parts) {
  const Shape shape(parts);
  std::size_t count = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) count += shape.tips(part).size();
  return count;
}

TEST(Shape, TipsAreTheConvexCornersOfTheUnion) {
  EXPECT_EQ(tips({{box(1, 1)}}), 4);
  EXPECT_EQ(tips({disc(1)}), 1);
  EXPECT_EQ(tips(letter_t()), 6);  // the stem's upper corners lie on the bar
  EXPECT_EQ(tips(cross()), 8);
  EXPECT_EQ(tips({{box(1, 1)}, placed({{box(1, 1)}}, 0.0, {1, 0})[0]}), 4);  // a common edge
  EXPECT_EQ(tips({{box(4, 4)}, {box(1, 1)}}), 4);                            // one within the other
  EXPECT_EQ(tips({{box(2, 2)}, {{{{0, 0}}}, 0.5}}), 4);                      // a disc within a box
  EXPECT_EQ(tips({{box(2, 2)}, {{{{1, 0}}}, 0.5}}), 5);
}

// The corner at the origin is convex and belongs to two pieces.
TEST(Shape, ATipOfTwoPartsCountsOnce) {
  EXPECT_EQ(tips({{Polygon{{{0, 0}, {2, 0}, {2, 2}}}}, {Polygon{{{0, 0}, {2, 2}, {0, 2}}}}}), 4);
}

TEST(Shape, SymmetryIsTheLeastTurnOntoItself) {
  EXPECT_EQ(Shape(disc(1)).symmetry(), 0.0);
  EXPECT_EQ(Shape(box(1, 1)).symmetry(), kPi / 2);
  EXPECT_EQ(Shape(Part{box(1, 2), 0.1}).symmetry(), kPi);
  EXPECT_EQ(Shape(letter_t()).centred().symmetry(), 2 * kPi);
  EXPECT_EQ(Shape(cross()).symmetry(), kPi / 2);
  const std::vector<Part> dumbbell{{box(2, 0.2)}, {{{{1, 0}}}, 0.4}, {{{{-1, 0}}}, 0.4}};
  EXPECT_EQ(Shape(dumbbell).symmetry(), kPi);
}

TEST(Shape, ADiscThatHoldsAllOtherPartsHasTheSymmetryOfADisc) {
  EXPECT_EQ(Shape({disc(1), disc(0.5)}).symmetry(), 0.0);
  EXPECT_EQ(Shape({{box(0.5, 0.5)}, disc(1)}).symmetry(), 0.0);
  EXPECT_EQ(Shape({disc(1), {box(1.5, 1.5)}}).symmetry(), kPi / 2);
}

double area(const std::vector<Polygon>& pieces) {
  double sum = 0.0;
  for (const Polygon& piece : pieces) sum += moments(piece).area;
  return sum;
}

TEST(ConvexPieces, CoverThePolygonWithLegalOnes) {
  const std::vector<std::vector<Vector2d>> rings{
      {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},                                // L
      {{-2, 1}, {-2, 0}, {-0.5, 0}, {-0.5, -3}, {0.5, -3}, {0.5, 0}, {2, 0}, {2, 1}},  // T
      {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}},                // U
      {{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}},  // an arrowhead
  };
  const std::vector<double> areas{3, 7, 7, 1};
  const std::vector<std::size_t> counts{2, 2, 3, 2};
  for (std::size_t n = 0; n < rings.size(); ++n) {
    const std::vector<Polygon> pieces = convex_pieces(rings[n]);
    EXPECT_EQ(pieces.size(), counts[n]) << n;
    EXPECT_NEAR(area(pieces), areas[n], 1e-12) << n;
    for (const Polygon& piece : pieces) EXPECT_EQ(polygon_defect(piece.vertices), std::nullopt);
  }
}

TEST(ConvexPieces, OfABoxWithAVertexOnItsEdgeAreTheBox) {
  const std::vector<Vector2d> ring{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}};
  ASSERT_EQ(convex_pieces(ring).size(), 1);
  EXPECT_EQ(convex_pieces(ring)[0].size(), 4);
}

TEST(DisjointPieces, OfRoundPartsAreFewAndAddUpToTheUnion) {
  std::vector<Part> star;
  for (int k = 0; k < 8; ++k)
    star.push_back(placed({{box(1.0, 0.2), 0.1}}, k * kPi / 4, rotate(k * kPi / 4, {0.7, 0}))[0]);
  const std::vector<std::pair<std::vector<Part>, std::size_t>> shapes{
      {letter_t(), 2}, {{{box(3, 0.6), 0.2}, {box(0.6, 3), 0.2}}, 12}, {star, 16}};
  for (const auto& [parts, most] : shapes) {
    const std::vector<Polygon> pieces = disjoint_pieces(parts);
    EXPECT_LE(pieces.size(), most);
    EXPECT_NEAR(area(pieces), union_moments(parts).area, 2e-3 * area(pieces));
    for (std::size_t m = 0; m < pieces.size(); ++m)
      for (std::size_t n = 0; n < m; ++n)
        EXPECT_LT(common_area(pieces[m].vertices, pieces[n].vertices), 1e-12);
  }
}

TEST(SelfContact, IsWhereARingCrossesItself) {
  const std::vector<Vector2d> bow{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, box_ring = box(1, 2).vertices;
  EXPECT_EQ(self_contact(bow), Vector2d(0.5, 0.5));
  EXPECT_EQ(self_contact(box_ring), std::nullopt);
}

TEST(Outline, OfAFrameHasAHole) {
  std::vector<Part> frame;
  for (int k = 0; k < 4; ++k)
    frame.push_back(placed({{box(4, 1)}}, k * kPi / 2, rotate(k * kPi / 2, {0, 1.5}))[0]);
  EXPECT_EQ(outline(frame).size(), 2);
  EXPECT_NEAR(Shape(frame).moments().area, 12.0, 1e-9);
  EXPECT_TRUE(in_one_piece(frame));
  frame.erase(frame.begin() + 1);
  frame.erase(frame.begin() + 2);
  EXPECT_FALSE(in_one_piece(frame));
}

TEST(InOnePiece, AsksForMoreThanACommonCorner) {
  const auto beside = [](double x, double y) {
    return in_one_piece(std::vector<Part>{{box(1, 1)}, placed({{box(1, 1)}}, 0.0, {x, y})[0]});
  };
  EXPECT_TRUE(beside(1.0, 0.5));
  EXPECT_TRUE(beside(1.0 + 1e-9, 0.5)) << "a gap by rounding";
  EXPECT_FALSE(beside(1.0 + 1e-5, 0.5));
  EXPECT_FALSE(beside(1.0, 1.0));
}

// Each disc is 1e-4 within the other, but the polygons of 64 sides for pictures are apart.
TEST(Outline, OfDiscsThatHardlyOverlapHasBoth) {
  const Vector2d to = 0.9999 * Vector2d(std::cos(kPi / 64), std::sin(kPi / 64));
  const std::vector<Part> discs{disc(0.5), placed({disc(0.5)}, 0.0, to)[0]};
  EXPECT_TRUE(in_one_piece(discs));
  EXPECT_EQ(outline(discs).size(), 2);
}

}  // namespace
}  // namespace rtg
