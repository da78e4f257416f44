#include "core/world/outline.hpp"

#include <geos_c.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

namespace rtg {
namespace {

constexpr int kQuadrantSides = 128;            // of a round corner, per quarter turn
constexpr int kPictureSides = 16;              // the same, in pictures
constexpr double kSameArea = 2e-4;             // difference of areas that count as one / area
constexpr double kCollinear = 1e-9;            // sine of the turn at a vertex that is left out
constexpr double kLeastCorner = 1e-6;          // sine of the turn at a convex corner
constexpr std::size_t kMaxPieceVertices = 64;  // of disjoint_pieces()
constexpr double kSnap = 1e-7;  // distance at which vertices and edges count as one / reach

/// GEOS's handle of a thread, with its last error.
struct Context {
  GEOSContextHandle_t handle = GEOS_init_r();
  std::string error;

  Context() {
    GEOSContext_setErrorMessageHandler_r(
        handle, [](const char* message, void* to) { static_cast<Context*>(to)->error = message; },
        this);
  }
  ~Context() { GEOS_finish_r(handle); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
};

Context& context() {
  thread_local Context one;
  return one;
}

GEOSContextHandle_t geos() { return context().handle; }

struct Destroy {
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(geos(), geometry); }
};
using Geometry = std::unique_ptr<GEOSGeometry, Destroy>;

/// Takes over what a function of GEOS returned. Throws std::runtime_error if it failed.
Geometry checked(GEOSGeometry* made) {
  if (!made) throw std::runtime_error("GEOS: " + context().error);
  return Geometry(made);
}

Geometry polygon_of(std::span<const Vector2d> ring) {
  std::vector<double> xy;
  for (std::size_t k = 0; k <= ring.size(); ++k) {
    const Vector2d& v = ring[k % ring.size()];
    xy.insert(xy.end(), {v.x(), v.y()});
  }
  GEOSCoordSequence* sequence = GEOSCoordSeq_copyFromBuffer_r(
      geos(), xy.data(), static_cast<unsigned>(ring.size() + 1), 0, 0);
  Geometry line = checked(GEOSGeom_createLinearRing_r(geos(), sequence));
  return checked(GEOSGeom_createPolygon_r(geos(), line.release(), nullptr, 0));
}

Geometry area_of(const Part& part, int sides) {
  const Vector2d& first = part.core.vertices[0];
  Geometry core = part.is_disc()
                      ? checked(GEOSGeom_createPointFromXY_r(geos(), first.x(), first.y()))
                      : polygon_of(part.core.vertices);
  if (part.radius == 0.0) return core;
  return checked(GEOSBuffer_r(geos(), core.get(), part.radius, sides));
}

/// Returns the polygons of `geometry`, without lines and points, which unions of areas that touch
/// can leave.
Geometry only_areas(Geometry geometry) {
  if (GEOSGeomTypeId_r(geos(), geometry.get()) != GEOS_GEOMETRYCOLLECTION) return geometry;
  return checked(GEOSBuffer_r(geos(), geometry.get(), 0.0, 1));
}

double reach_of(std::span<const Part> parts) {
  double reach = 0.0;
  for (const Part& part : parts) reach = std::max(reach, reach_from(Vector2d::Zero(), part));
  return reach;
}

/// Vertices are rounded to a grid of 2^-36 of the size. The area of the result is right to that,
/// but it may be in more pieces than the union: part by part, rounding moves edges off each other.
Geometry union_of(std::span<const Part> parts, int sides = kQuadrantSides) {
  const double grid = std::ldexp(1.0, std::ilogb(reach_of(parts)) - 36);
  Geometry all = area_of(parts[0], sides);
  for (const Part& part : parts.subspan(1))
    all = only_areas(checked(GEOSUnionPrec_r(geos(), all.get(), area_of(part, sides).get(), grid)));
  return all;
}

/// Returns the ends of all straight edges of the parts; of those within `snap` of each other one.
std::vector<Vector2d> edge_ends(std::span<const Part> parts, double snap) {
  std::vector<Vector2d> ends;
  const auto add = [&](const Vector2d& v) {
    if (std::ranges::none_of(ends, [&](const Vector2d& w) { return (v - w).norm() <= snap; }))
      ends.push_back(v);
  };
  for (const auto& [core, radius] : parts)
    for (std::size_t k = 0; core.size() > 1 && k < core.size(); ++k) {
      const Vector2d out = radius * edge_normal(core, k);
      add(core.vertices[k] + out);
      add(core.vertices[(k + 1) % core.size()] + out);
    }
  return ends;
}

Geometry collected(std::vector<Geometry> members) {
  std::vector<GEOSGeometry*> owned;
  for (Geometry& member : members) owned.push_back(member.release());
  return checked(GEOSGeom_createCollection_r(geos(), GEOS_GEOMETRYCOLLECTION, owned.data(),
                                             static_cast<unsigned>(owned.size())));
}

/// The union in as many pieces as it has: parts whose edges lie within kSnap of each other hang
/// together. For that, the ends of all edges become vertices of the parts on whose outline they
/// lie, so that neighbours have the same ones.
Geometry seamless_union_of(std::span<const Part> parts, int sides) {
  const double snap = kSnap * reach_of(parts);
  std::vector<Geometry> points, areas;
  for (const Vector2d& v : edge_ends(parts, snap))
    points.push_back(checked(GEOSGeom_createPointFromXY_r(geos(), v.x(), v.y())));
  const Geometry ends = collected(std::move(points));
  for (const Part& part : parts)
    areas.push_back(checked(GEOSSnap_r(geos(), area_of(part, sides).get(), ends.get(), snap)));
  return only_areas(checked(GEOSUnaryUnion_r(geos(), collected(std::move(areas)).get())));
}

/// Returns the vertices of a ring, without the last, which is the first.
std::vector<Vector2d> vertices_of(const GEOSGeometry* ring) {
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(geos(), ring);
  unsigned count = 0;
  GEOSCoordSeq_getSize_r(geos(), sequence, &count);
  std::vector<Vector2d> out(count - 1);
  for (unsigned k = 0; k + 1 < count; ++k)
    GEOSCoordSeq_getXY_r(geos(), sequence, k, &out[k].x(), &out[k].y());
  return out;
}

/// Adds the integrals over the polygons of `area`; those of holes count negative.
void add(const GEOSGeometry* area, AreaIntegrals& sum) {
  for (int n = 0; n < GEOSGetNumGeometries_r(geos(), area); ++n) {
    const GEOSGeometry* polygon = GEOSGetGeometryN_r(geos(), area, n);
    if (GEOSGeomTypeId_r(geos(), polygon) != GEOS_POLYGON || GEOSisEmpty_r(geos(), polygon))
      continue;  // differences by rounding leave lines, or nothing
    const auto add_ring = [&sum](const GEOSGeometry* ring, double sign) {
      const AreaIntegrals one = area_integrals(vertices_of(ring));
      sum.add(one, one.area < 0.0 ? -sign : sign);
    };
    add_ring(GEOSGetExteriorRing_r(geos(), polygon), 1.0);
    for (int hole = 0; hole < GEOSGetNumInteriorRings_r(geos(), polygon); ++hole)
      add_ring(GEOSGetInteriorRingN_r(geos(), polygon, hole), -1.0);
  }
}

double area_in(const GEOSGeometry* area) {
  AreaIntegrals sum;
  add(area, sum);
  return sum.area;
}

/// Returns the sine of the turn at vertex k of a ring; positive to the left.
double turn_at(std::span<const Vector2d> ring, std::size_t k) {
  const std::size_t count = ring.size();
  const Vector2d before = (ring[k] - ring[(k + count - 1) % count]).normalized();
  const Vector2d after = (ring[(k + 1) % count] - ring[k]).normalized();
  return before.x() * after.y() - before.y() * after.x();
}

/// Returns the polygon of two that share the edge from vertex i of `a`, which is the edge from
/// vertex j of `b` reversed. Returns nothing if it is not convex or has more than `most` vertices.
std::optional<Polygon> joined(const Polygon& a, std::size_t i, const Polygon& b, std::size_t j,
                              std::size_t most) {
  std::vector<Vector2d> ring;
  for (std::size_t k = 1; k <= a.size(); ++k) ring.push_back(a.vertices[(i + k) % a.size()]);
  for (std::size_t k = 2; k < b.size(); ++k) ring.push_back(b.vertices[(j + k) % b.size()]);
  Polygon out;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const double turn = turn_at(ring, k);
    if (std::abs(turn) <= kCollinear) continue;
    if (turn < kLeastCorner) return std::nullopt;
    out.vertices.push_back(ring[k]);
  }
  if (out.size() > most) return std::nullopt;
  return out;
}

/// An edge of a piece, by its ends.
using Edge = std::array<double, 4>;

Edge edge_of(const Polygon& piece, std::size_t k, bool reversed) {
  const Vector2d &v = piece.vertices[k], &w = piece.vertices[(k + 1) % piece.size()];
  if (reversed) return {w.x(), w.y(), v.x(), v.y()};
  return {v.x(), v.y(), w.x(), w.y()};
}

/// Joins two pieces at the longest edge at which their union is convex and has at most `most`
/// vertices; of equally long ones at that of the first pieces. Returns whether there is such an
/// edge.
bool join_longest(std::vector<Polygon>& pieces, std::size_t most) {
  std::map<Edge, std::pair<std::size_t, std::size_t>> places;  // piece and index of an edge
  for (std::size_t n = 0; n < pieces.size(); ++n)
    for (std::size_t j = 0; j < pieces[n].size(); ++j)
      places.emplace(edge_of(pieces[n], j, true), std::pair{n, j});
  double longest = 0.0;
  std::size_t first = 0, second = 0;
  std::optional<Polygon> best;
  for (std::size_t m = 0; m < pieces.size(); ++m)
    for (std::size_t i = 0; i < pieces[m].size(); ++i) {
      const Edge edge = edge_of(pieces[m], i, false);
      const auto found = places.find(edge);
      if (found == places.end() || found->second.first <= m) continue;
      const auto [n, j] = found->second;
      const double length = Vector2d(edge[2] - edge[0], edge[3] - edge[1]).norm();
      if (length < longest || (length == longest && (first != m || second <= n))) continue;
      std::optional<Polygon> one = joined(pieces[m], i, pieces[n], j, most);
      if (!one) continue;
      best = std::move(one);
      longest = length;
      first = m;
      second = n;
    }
  if (!best) return false;
  pieces[first] = *std::move(best);
  pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(second));
  return true;
}

/// Splits a polygon into its constrained Delaunay triangles and joins them while that is convex and
/// has at most `most` vertices.
std::vector<Polygon> pieces_of(const GEOSGeometry& polygon, std::size_t most) {
  const Geometry triangles = checked(GEOSConstrainedDelaunayTriangulation_r(geos(), &polygon));
  std::vector<Polygon> pieces;
  for (int n = 0; n < GEOSGetNumGeometries_r(geos(), triangles.get()); ++n) {
    Polygon one{
        vertices_of(GEOSGetExteriorRing_r(geos(), GEOSGetGeometryN_r(geos(), triangles.get(), n)))};
    if (area_integrals(one.vertices).area < 0.0) std::ranges::reverse(one.vertices);
    pieces.push_back(std::move(one));
  }
  while (join_longest(pieces, most)) {
  }
  return pieces;
}

}  // namespace

Moments union_moments(std::span<const Part> parts) {
  AreaIntegrals sum;
  add(union_of(parts).get(), sum);
  return sum.moments();
}

std::vector<std::vector<Vector2d>> outline(std::span<const Part> parts) {
  if (parts.size() == 1 && parts[0].radius == 0.0) return {parts[0].core.vertices};
  const Geometry all = seamless_union_of(parts, kPictureSides);
  std::vector<std::vector<Vector2d>> rings;
  for (int n = 0; n < GEOSGetNumGeometries_r(geos(), all.get()); ++n) {
    const GEOSGeometry* piece = GEOSGetGeometryN_r(geos(), all.get(), n);
    rings.push_back(vertices_of(GEOSGetExteriorRing_r(geos(), piece)));
    for (int hole = 0; hole < GEOSGetNumInteriorRings_r(geos(), piece); ++hole)
      rings.push_back(vertices_of(GEOSGetInteriorRingN_r(geos(), piece, hole)));
  }
  return rings;
}

bool in_one_piece(std::span<const Part> parts) {
  return GEOSGetNumGeometries_r(geos(), seamless_union_of(parts, kQuadrantSides).get()) == 1;
}

bool maps_onto_itself(std::span<const Part> parts, double angle) {
  const Geometry here = union_of(parts);
  const Geometry there = union_of(placed({parts.begin(), parts.end()}, angle, Vector2d::Zero()));
  const Geometry difference = checked(GEOSSymDifference_r(geos(), here.get(), there.get()));
  return area_in(difference.get()) <= kSameArea * area_in(here.get());
}

std::optional<Vector2d> self_contact(std::span<const Vector2d> ring) {
  const Geometry polygon = polygon_of(ring);
  GEOSGeometry* place = nullptr;
  if (GEOSisValidDetail_r(geos(), polygon.get(), 0, nullptr, &place) == 1) return std::nullopt;
  const Geometry found = checked(place);
  Vector2d x = Vector2d::Zero();
  GEOSGeomGetX_r(geos(), found.get(), &x.x());
  GEOSGeomGetY_r(geos(), found.get(), &x.y());
  return x;
}

std::vector<Polygon> disjoint_pieces(std::span<const Part> parts) {
  if (parts.size() > 1) return pieces_of(*union_of(parts, kPictureSides), kMaxPieceVertices);
  Polygon only{outline(parts)[0]};
  if (area_integrals(only.vertices).area < 0.0) std::ranges::reverse(only.vertices);
  return {std::move(only)};
}

std::vector<Polygon> convex_pieces(std::span<const Vector2d> ring) {
  return pieces_of(*polygon_of(ring), kMaxVertices);
}

}  // namespace rtg
