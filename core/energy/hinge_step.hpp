#pragma once

#include "core/energy/articulation.hpp"
#include "core/math/register_sum.hpp"

namespace rtg::energy {

/// Change of coordinates at one hinge. In the old coordinates the child has a pose of its own. In
/// the new ones its position follows from the parent's pose and the child's angle. Hence
///
///   dt_j = dt_i + E A dθ_i - E B dθ_j,   A = R_i a, B = R_j b.
///
/// T = ∂(old)/∂(new) is the identity except for these rows. A force g becomes Tᵀ g. A Hessian H
/// becomes Tᵀ H T + Σ g ∂²(old)/∂(new)². Apply the steps hinge by hinge, from the leaves to the
/// roots.
template <class T>
class HingeStep {
 public:
  HingeStep(const Articulation<T>& of, const Hinge<T>& hinge, const Placement<T>& at)
      : i_(hinge.parent),
        j_(hinge.child),
        parent_is_movable_(of.movable(hinge.parent)),
        arms_(hinge, at) {}

  /// g ← Tᵀ g.
  void gather(T* g) const {
    T* child = g + 3 * j_;
    const T x = child[0], y = child[1];
    child[0] = child[1] = T(0.0);
    child[2] = child[2] + arms_.b.y() * x - arms_.b.x() * y;
    if (!parent_is_movable_) return;
    T* parent = g + 3 * i_;
    parent[0] = parent[0] + x;
    parent[1] = parent[1] + y;
    parent[2] = parent[2] + arms_.a.x() * y - arms_.a.y() * x;
  }

  /// M ← Tᵀ M.
  void gather_rows(BlockMatrix<T>& M) const {
    for (const int k : Bits(M.pattern[static_cast<std::size_t>(j_)])) {
      Block<T>& child = M.at(j_, k);
      Block<T> parent = child;
      for (int m = 0; m < 3; ++m) {
        const T x = child(0, m), y = child(1, m);
        parent(2, m) = arms_.a.x() * y - arms_.a.y() * x;
        child(0, m) = child(1, m) = T(0.0);
        child(2, m) += arms_.b.y() * x - arms_.b.x() * y;
      }
      if (parent_is_movable_) M.add(i_, k, parent);
    }
  }

  /// M ← M T.
  void gather_columns(BlockMatrix<T>& M) const {
    for (int k = 0; k < M.M; ++k) {
      if (!M.has(k, j_)) continue;
      Block<T>& child = M.at(k, j_);
      Block<T> parent = child;
      for (int m = 0; m < 3; ++m) {
        const T x = child(m, 0), y = child(m, 1);
        parent(m, 2) = arms_.a.x() * y - arms_.a.y() * x;
        child(m, 0) = child(m, 1) = T(0.0);
        child(m, 2) += arms_.b.y() * x - arms_.b.x() * y;
      }
      if (parent_is_movable_) M.add(k, i_, parent);
    }
  }

  /// H ← Tᵀ H T, for both halves of H. The child's x and y are no longer coordinates: their rows
  /// and columns become those of the identity.
  void gather_both(BlockMatrix<T>& H) const {
    gather_rows(H);
    gather_columns(H);
    Block<T>& own = H.at(j_, j_);
    own(0, 0) = own(1, 1) = T(1.0);
  }

  /// Adds `weight` · Σ g ∂²(old)/∂(new)² to `H`. `g` is the force in the old coordinates, before
  /// gather().
  void add_curvature(const T* g, const T& weight, BlockMatrix<T>& H) const {
    const T x = g[3 * j_], y = g[3 * j_ + 1];
    H.at(j_, j_)(2, 2) += weight * (arms_.b.x() * x + arms_.b.y() * y);
    if (parent_is_movable_) H.at(i_, i_)(2, 2) -= weight * (arms_.a.x() * x + arms_.a.y() * y);
  }

  const Arms<T>& arms() const { return arms_; }
  int parent() const { return i_; }
  int child() const { return j_; }
  /// Returns whether the parent has coordinates.
  bool parent_is_movable() const { return parent_is_movable_; }

 private:
  int i_, j_;
  bool parent_is_movable_;
  Arms<T> arms_;
};

/// Fills the upper half of a symmetric matrix from the lower half.
template <class T>
void mirror_lower(BlockMatrix<T>& H) {
  for (int i = 0; i < H.M; ++i)
    for (int j = 0; j < i; ++j) {
      if (!H.has(i, j)) continue;
      H.pattern[static_cast<std::size_t>(j)] |= std::uint64_t{1} << i;
      H.at(j, i) = H.at(i, j).transpose();
    }
}

}  // namespace rtg::energy
