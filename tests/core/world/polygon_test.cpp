#include "core/world/polygon.hpp"

#include <gtest/gtest.h>

namespace rtg {
namespace {

// Reference values of shapely, pymunk and Box2D, which agree.
TEST(Polygon, MomentsMatchReferenceValues) {
  const Polygon shape{{{.1, -.4}, {.9, -.3}, {1.2, .5}, {.4, .9}, {-.2, .3}}};
  const Moments m = moments(shape);
  EXPECT_NEAR(m.area, 1.185, 1e-12);
  EXPECT_NEAR(m.centroid.x(), .4914205, 1e-7);
  EXPECT_NEAR(m.centroid.y(), .2135021, 1e-7);
  EXPECT_NEAR(m.polar + m.area * m.centroid.squaredNorm(), .5689833333, 1e-9);
}

TEST(Polygon, PolarMomentOfABoxIsTheTextbookOne) {
  const Moments m = moments(box(1.2, 0.7));
  EXPECT_NEAR(m.polar, 1.2 * 0.7 * (1.2 * 1.2 + 0.7 * 0.7) / 12.0, 1e-12);
}

TEST(Polygon, MomentsDoNotDependOnTheOrigin) {
  Polygon shape = regular_polygon(5, 0.8);
  const double polar = moments(shape).polar;
  for (Vector2d& v : shape.vertices) v += Vector2d(3.0, -2.0);
  EXPECT_NEAR(moments(shape).polar, polar, 1e-12);
  EXPECT_NEAR(moments(centred(shape)).centroid.norm(), 0.0, 1e-12);
}

TEST(Polygon, DefectsAreNamed) {
  using V = std::vector<Vector2d>;
  const V clockwise{{0, 0}, {0, 1}, {1, 1}, {1, 0}}, dent{{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}},
      star{{0, 1}, {-0.6, -0.8}, {1, 0.3}, {-1, 0.3}, {0.6, -0.8}}, two{{0, 0}, {1, 0}},
      flat{{0, 0}, {1, 0}, {2, 0}}, nan{{0, 0}, {NAN, 0}, {0, 1}};
  EXPECT_EQ(polygon_defect(clockwise), "is clockwise; list the vertices counter-clockwise");
  EXPECT_EQ(polygon_defect(dent), "is not strictly convex at vertex 2");
  EXPECT_EQ(polygon_defect(star), "crosses itself");
  EXPECT_EQ(polygon_defect(two), "has 2 vertices, not 3 to 8");
  EXPECT_EQ(polygon_defect(flat), "is not strictly convex at vertex 1");
  EXPECT_EQ(polygon_defect(nan), "vertex 1 is not finite or beyond 1000 m");
  EXPECT_EQ(polygon_defect(box(1, 2).vertices), std::nullopt);
}

TEST(Polygon, AnOffsetMovesEveryEdgeAndMitresCorners) {
  const Polygon larger = offset_polygon(box(1.0, 0.4), 0.1), expected = box(1.2, 0.6);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT((larger.vertices[k] - expected.vertices[k]).norm(), 1e-15);
  // A triangle's corner of 60° goes out by 1/sin 30° of the offset.
  EXPECT_NEAR(bounding_radius(offset_polygon(regular_polygon(3, 1.0), 0.1)), 1.2, 1e-14);
}

TEST(SymmetryOrder, CountsTheTurnsThatMapAShapeOntoItself) {
  for (int sides = 3; sides <= 8; ++sides)
    EXPECT_EQ(symmetry_order(regular_polygon(sides, 0.8)), sides);
  EXPECT_EQ(symmetry_order(box(1.2, 1.2)), 4);
  EXPECT_EQ(symmetry_order(box(1.2, 0.7)), 2);
  EXPECT_EQ(symmetry_order({{{1, 0}, {0, 2}, {-1, 0}, {0, -2}}}), 2);               // a rhombus
  EXPECT_EQ(symmetry_order(centred({{{-1, 0}, {1, 0}, {0, 3}}})), 1);               // isosceles
  EXPECT_EQ(symmetry_order(centred({{{-1, 0}, {1, 0}, {0.5, 1}, {-0.5, 1}}})), 1);  // trapezium
}

TEST(SymmetryOrder, OfAHexagonWithTwoKindsOfCornersIsThree) {
  Polygon shape = regular_polygon(6, 0.8);
  for (std::size_t k = 0; k < 6; k += 2) shape.vertices[k] *= 1.2;
  EXPECT_EQ(symmetry_order(shape), 3);
}

TEST(SymmetryOrder, OfAnAlmostSquareBoxIsTwo) { EXPECT_EQ(symmetry_order(box(1.2, 1.201)), 2); }

}  // namespace
}  // namespace rtg
