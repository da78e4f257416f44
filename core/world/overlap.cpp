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

/// Cuts off the part of `ring` to the right of the line from `v` to `w`.
void keep_left(Ring& ring, const Vector2d& v, const Vector2d& w) {
  std::array<double, kRoom> side;
  bool all = true;
  for (std::size_t k = 0; k < ring.size; ++k) {
    side[k] = cross(w - v, ring.vertices[k] - v);
    all = all && side[k] >= 0.0;
  }
  if (all) return;
  Ring out;
  for (std::size_t k = 0; k < ring.size; ++k) {
    const std::size_t next = (k + 1) % ring.size;
    const Vector2d &a = ring.vertices[k], &b = ring.vertices[next];
    const double from = side[k], to = side[next];
    if (from >= 0.0) out.add(a);
    if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0))
      out.add(a + from / (from - to) * (b - a));
  }
  std::copy_n(out.vertices.begin(), out.size, ring.vertices.begin());
  ring.size = out.size;
}

/// The smallest rectangle along the axes that contains `ring`.
struct Bounds {
  Vector2d least, most;

  explicit Bounds(std::span<const Vector2d> ring) : least(ring[0]), most(ring[0]) {
    for (const Vector2d& v : ring) {
      least = least.cwiseMin(v);
      most = most.cwiseMax(v);
    }
  }
  bool meets(const Bounds& other) const {
    return (least.array() <= other.most.array()).all() &&
           (other.least.array() <= most.array()).all();
  }
};

}  // namespace

std::vector<Vector2d> inset_ring(std::span<const Vector2d> ring, double by) {
  Ring out;
  for (const Vector2d& v : ring) out.add(v);
  for (std::size_t k = 0; k < ring.size() && out.size > 0; ++k) {
    const Vector2d &v = ring[k], &w = ring[(k + 1) % ring.size()];
    const Vector2d inwards = by * Vector2d(v.y() - w.y(), w.x() - v.x()).normalized();
    keep_left(out, v + inwards, w + inwards);
  }
  return {out.vertices.begin(), out.vertices.begin() + static_cast<std::ptrdiff_t>(out.size)};
}

/// Clips `a` by the edges of `b` [Sutherland and Hodgman 1974].
double common_area(std::span<const Vector2d> a, std::span<const Vector2d> b) {
  Ring ring;
  for (const Vector2d& v : a) ring.add(v);
  for (std::size_t k = 0; k < b.size() && ring.size > 0; ++k)
    keep_left(ring, b[k], b[(k + 1) % b.size()]);
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
    const Bounds around(there);
    for (const Polygon& other : shape.pieces())
      if (around.meets(Bounds(other.vertices))) common += common_area(there, other.vertices);
  }
  return common / whole;
}

}  // namespace rtg
