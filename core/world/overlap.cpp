#include "core/world/overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rtg {
namespace {

/// Room for a polygon that is cut by the edges of another: each adds a vertex at most.
constexpr std::size_t kRoom = 256;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Vertices on the stack.
struct Ring {
  std::array<Vector2d, kRoom> vertices;
  std::size_t size = 0;

  void add(const Vector2d& v) { vertices[size++] = v; }
};

/// Returns the part of `ring` to the left of the line from `v` to `w`.
Ring left_of(const Ring& ring, const Vector2d& v, const Vector2d& w) {
  Ring out;
  const auto side = [&](const Vector2d& x) { return cross(w - v, x - v); };
  for (std::size_t k = 0; k < ring.size; ++k) {
    const Vector2d &a = ring.vertices[k], &b = ring.vertices[(k + 1) % ring.size];
    const double from = side(a), to = side(b);
    if (from >= 0.0) out.add(a);
    if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0))
      out.add(a + from / (from - to) * (b - a));
  }
  return out;
}

}  // namespace

std::vector<Vector2d> inset_ring(std::span<const Vector2d> ring, double by) {
  Ring out;
  for (const Vector2d& v : ring) out.add(v);
  for (std::size_t k = 0; k < ring.size() && out.size > 0; ++k) {
    const Vector2d &v = ring[k], &w = ring[(k + 1) % ring.size()];
    const Vector2d inwards = by * Vector2d(v.y() - w.y(), w.x() - v.x()).normalized();
    out = left_of(out, v + inwards, w + inwards);
  }
  return {out.vertices.begin(), out.vertices.begin() + static_cast<std::ptrdiff_t>(out.size)};
}

/// Clips `a` by the edges of `b` [Sutherland and Hodgman 1974].
double common_area(std::span<const Vector2d> a, std::span<const Vector2d> b) {
  Ring ring;
  for (const Vector2d& v : a) ring.add(v);
  for (std::size_t k = 0; k < b.size() && ring.size > 0; ++k)
    ring = left_of(ring, b[k], b[(k + 1) % b.size()]);
  double twice = 0.0;
  for (std::size_t k = 0; k < ring.size; ++k)
    twice += cross(ring.vertices[k], ring.vertices[(k + 1) % ring.size]);
  return twice / 2.0;
}

double covered_share(const Shape& shape, const Pose& at, const Pose& target) {
  if ((at.position() - target.position()).norm() >= 2.0 * shape.radius()) return 0.0;
  double common = 0.0, whole = 0.0;
  for (const Polygon& piece : shape.pieces()) {
    whole += moments(piece).area;
    std::array<Vector2d, kRoom> moved;
    std::ranges::transform(piece.vertices, moved.begin(),
                           [&](const Vector2d& v) { return to_local(target, to_world(at, v)); });
    const std::span<const Vector2d> there(moved.data(), piece.size());
    for (const Polygon& other : shape.pieces()) common += common_area(there, other.vertices);
  }
  return common / whole;
}

}  // namespace rtg
