#pragma once

#include <vector>

#include "core/math/block_matrix.hpp"
#include "core/math/elementary_lanes.hpp"

namespace rtg::energy {

/// Poses of all bodies with the cosines and sines of their angles.
template <class T>
struct Placement {
  explicit Placement(int bodies = 0)
      : p(3 * static_cast<std::size_t>(bodies), T(0.0)), turns(static_cast<std::size_t>(bodies)) {}

  /// Recomputes `turns`; must be called after each change of p.
  void update() {
    for (std::size_t i = 0; i < turns.size(); ++i) turns[i] = turn_of(p[3 * i + 2]);
  }
  T* body(int i) { return p.data() + 3 * i; }
  const T* body(int i) const { return p.data() + 3 * i; }

  /// Copies `other` in the lanes `where`.
  void assign(const Mask<T>& where, const Placement& other) {
    for (std::size_t m = 0; m < p.size(); ++m) p[m] = select(where, other.p[m], p[m]);
    for (std::size_t i = 0; i < turns.size(); ++i) {
      turns[i].c = select(where, other.turns[i].c, turns[i].c);
      turns[i].s = select(where, other.turns[i].s, turns[i].s);
    }
  }

  std::vector<T> p;  // x, y, θ per body
  std::vector<Turn<T>> turns;
};

/// Returns the displacement (Δx, Δy, Δθ) of a body from one placement to another.
template <class T>
Vec3<T> displacement(const Placement<T>& from, const Placement<T>& to, int body) {
  const T *a = from.body(body), *b = to.body(body);
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

}  // namespace rtg::energy
