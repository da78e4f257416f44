#pragma once

#include "core/energy/articulation.hpp"
#include "core/energy/pair_frame.hpp"
#include "core/math/register_sum.hpp"

namespace rtg::energy {

/// Change of coordinates at one joint. In the old coordinates the child j has a pose of its own. In
/// the new ones its pose follows from that of the parent i and from the child's coordinate, θ_j or
/// s, if it has one:
///
///   revolute:          dt_j = dt_i + E A dθ_i - E B dθ_j,   A = R_i a, B = R_j b
///   prismatic, fixed:  dt_j = dt_i + E D dθ_i + U ds,   dθ_j = dθ_i,   D = t_j - t_i, U = R_i u
///
/// where E turns by +90°. L denotes A or D, C denotes -E B or U. T = ∂(old)/∂(new) is the identity
/// except for these rows. A force g becomes Tᵀ g. A Hessian H becomes Tᵀ H T + Σ g ∂²(old)/∂(new)²
/// with
///
///   ∂²t_j/∂θ_i² = -L,   ∂²t_j/∂θ_j² = E C (revolute),   ∂²t_j/∂θ_i∂s = E C (prismatic).
///
/// Apply the steps joint by joint, from the leaves to the roots.
template <class T>
class JointStep {
 public:
  JointStep(const Articulation<T>& of, const JointModel<T>& joint, const Placement<T>& at)
      : i_(joint.parent),
        j_(joint.child),
        slot_(slot_of(joint.type)),
        parent_is_movable_(of.movable(joint.parent)) {
    const Turn<T>& turn = at.turns[static_cast<std::size_t>(i_)];
    if (joint.is_revolute()) {
      lever_ = turned_by(turn, joint.a);
      const Vec2<T> b = turned_by(at.turns[static_cast<std::size_t>(j_)], joint.b);
      along_ = {b.y(), -b.x()};
    } else {
      lever_ = {at.body(j_)[0] - at.body(i_)[0], at.body(j_)[1] - at.body(i_)[1]};
      along_ = turned_by(turn, joint.axis);
    }
  }

  /// y ← T y, with y over the new coordinates.
  void spread(T* y) const {
    T* child = y + 3 * j_;
    const T own = slot_ < 0 ? T(0.0) : child[slot_];
    for (int m = 0; m < 2; ++m) child[m] = slot_ < 0 ? T(0.0) : along_[m] * own;
    if (!is_revolute()) child[2] = T(0.0);
    if (!parent_is_movable_) return;
    const T* parent = y + 3 * i_;
    child[0] = child[0] + parent[0] - lever_.y() * parent[2];
    child[1] = child[1] + parent[1] + lever_.x() * parent[2];
    if (!is_revolute()) child[2] = parent[2];
  }
  /// Reverses spread().
  void undo_spread(T* w) const {
    const T own = is_revolute() ? w[3 * j_ + 2] : value_rate(w);
    for (int m = 0; m < 3; ++m) w[3 * j_ + m] = T(0.0);
    if (slot_ >= 0) w[3 * j_ + slot_] = own;
  }
  /// Returns the rate of the joint's value along a motion `w` in the old coordinates.
  T value_rate(const T* w) const {
    const T *child = w + 3 * j_, *parent = w + 3 * i_;
    if (is_revolute()) return parent_is_movable_ ? child[2] - parent[2] : child[2];
    if (slot_ < 0) return T(0.0);
    if (!parent_is_movable_) return along_.x() * child[0] + along_.y() * child[1];
    return along_.x() * (child[0] - parent[0] + lever_.y() * parent[2]) +
           along_.y() * (child[1] - parent[1] - lever_.x() * parent[2]);
  }

  /// g ← Tᵀ g.
  void gather(T* g) const {
    T* child = g + 3 * j_;
    const T x = child[0], y = child[1], t = child[2];
    set_child(x, y, t, [child](int m) -> T& { return child[m]; });
    if (!parent_is_movable_) return;
    T* parent = g + 3 * i_;
    parent[0] = parent[0] + x;
    parent[1] = parent[1] + y;
    parent[2] = parent[2] + at_parent(x, y, t);
  }
  /// M ← Tᵀ M.
  void gather_rows(BlockMatrix<T>& M) const {
    for (const int k : Bits(M.pattern[static_cast<std::size_t>(j_)])) {
      Block<T>& child = M.at(j_, k);
      Block<T> parent = child;
      for (int m = 0; m < 3; ++m) {
        const T x = child(0, m), y = child(1, m), t = child(2, m);
        parent(2, m) = at_parent(x, y, t);
        set_child(x, y, t, [&child, m](int row) -> T& { return child(row, m); });
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
        const T x = child(m, 0), y = child(m, 1), t = child(m, 2);
        parent(m, 2) = at_parent(x, y, t);
        set_child(x, y, t, [&child, m](int column) -> T& { return child(m, column); });
      }
      if (parent_is_movable_) M.add(k, i_, parent);
    }
  }
  /// H ← Tᵀ H T, for both halves of H.
  void gather_both(BlockMatrix<T>& H) const {
    gather_rows(H);
    gather_columns(H);
    fill_unused(H);
  }
  /// Makes rows and columns of H that belong to no coordinate those of the identity.
  void fill_unused(BlockMatrix<T>& H) const {
    Block<T>& own = H.at(j_, j_);
    for (int m = 0; m < 3; ++m)
      if (m != slot_) own(m, m) = T(1.0);
  }
  /// Adds `weight` · Σ g ∂²(old)/∂(new)² to `H`. `g` is the force in the old coordinates, before
  /// gather().
  void add_curvature(const T* g, const T& weight, BlockMatrix<T>& H) const {
    const Vec2<T> force(g[3 * j_], g[3 * j_ + 1]);
    if (slot_ >= 0) add_child_curvature(weight * dot(turned(along_), force), H);
    if (parent_is_movable_) H.at(i_, i_)(2, 2) -= weight * dot(lever_, force);
  }
  /// Adds `x` to both entries of `H` that ∂²t_j/∂θ_j² or ∂²t_j/∂θ_i∂s belongs to.
  void add_child_curvature(const T& x, BlockMatrix<T>& H) const {
    if (is_revolute()) H.at(j_, j_)(2, 2) += x;
    if (!is_revolute() && parent_is_movable_) add_entry(j_, slot_, i_, 2, x, H);
  }

  /// Adds `f` ∇v to the force `g` over the new coordinates. v is the joint's value, φ or s.
  void add_force(const T& f, T* g) const {
    if (slot_ < 0) return;
    g[3 * j_ + slot_] = g[3 * j_ + slot_] + f;
    if (has_parent_angle()) g[3 * i_ + 2] = g[3 * i_ + 2] - f;
  }
  /// Adds `f` ∇v ∇vᵀ to both halves of `H` over the new coordinates.
  void add_stiffness(const T& f, BlockMatrix<T>& H) const {
    if (slot_ < 0) return;
    H.at(j_, j_)(slot_, slot_) += f;
    if (!has_parent_angle()) return;
    H.at(i_, i_)(2, 2) += f;
    add_entry(j_, 2, i_, 2, -f, H);
  }

  /// Rates ∂w_j/∂θ_i and ∂w_j/∂(θ_j or s) at fixed multipliers y, with w = J y [m/rad], [1].
  struct Rates {
    Vec2<T> by_parent, by_child;
  };
  /// `w` holds the multipliers over the old coordinates.
  Rates multiplier_rates(const T* w) const {
    const T turn = parent_is_movable_ ? w[3 * i_ + 2] : T(0.0);
    const Vec2<T> across = turned(along_);
    Rates rates{lever_ * -turn, {T(0.0), T(0.0)}};
    if (is_revolute()) rates.by_child = across * w[3 * j_ + 2];
    if (slot_ != 0) return rates;
    rates.by_child = across * turn;
    rates.by_parent += across * value_rate(w);
    return rates;
  }

  int parent() const { return i_; }
  int child() const { return j_; }
  /// Returns which of the child's three entries belongs to its coordinate; negative if it has none.
  int slot() const { return slot_; }
  /// Returns whether the parent has coordinates.
  bool parent_is_movable() const { return parent_is_movable_; }

 private:
  bool is_revolute() const { return slot_ == 2; }
  bool has_parent_angle() const { return is_revolute() && parent_is_movable_; }
  static T dot(const Vec2<T>& a, const Vec2<T>& b) { return a.x() * b.x() + a.y() * b.y(); }

  /// Returns what a force (x, y) and torque t on the child adds to the torque on the parent.
  T at_parent(const T& x, const T& y, const T& t) const {
    const T torque = lever_.x() * y - lever_.y() * x;
    return is_revolute() ? torque : torque + t;
  }
  /// Sets the child's three entries to the force on its coordinate.
  template <class Entry>
  void set_child(const T& x, const T& y, const T& t, Entry entry) const {
    const T own = along_.x() * x + along_.y() * y;
    entry(0) = slot_ == 0 ? own : T(0.0);
    entry(1) = T(0.0);
    entry(2) = is_revolute() ? t + own : T(0.0);
  }
  /// Adds x at (row of body a, column of body b) and at the mirrored entry.
  static void add_entry(int a, int row, int b, int column, const T& x, BlockMatrix<T>& H) {
    Block<T> entry = Block<T>::Constant(T(0.0));
    entry(row, column) = x;
    H.add(a, b, entry);
    H.add(b, a, entry.transpose());
  }

  int i_, j_, slot_;
  bool parent_is_movable_;
  Vec2<T> lever_, along_;  // L, C
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
