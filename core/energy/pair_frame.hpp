#pragma once

#include "core/math/block_matrix.hpp"
#include "core/math/elementary_lanes.hpp"
#include "core/world/signed_distance.hpp"

namespace rtg::energy {

/// Returns E a with E = [0 -1; 1 0], the rotation by +90°.
template <class T>
Vec2<T> turned(const Vec2<T>& a) {
  return {-a.y(), a.x()};
}

/// Returns D a. Eigen's own product does not compile for 2 × 2 matrices of Lanes.
template <class T>
Vec2<T> product(const Mat2<T>& D, const Vec2<T>& a) {
  return {D(0, 0) * a.x() + D(0, 1) * a.y(), D(1, 0) * a.x() + D(1, 1) * a.y()};
}

/// The pose of body i relative to body j. Distances and slips depend on this relative pose alone.
/// They are differentiated with respect to four coordinates u of the pair instead of the six in q:
///
///   du = (R(θ_j)ᵀ (dt_i - dt_j), dθ_i, dθ_j) = V dq,   q = (p_i, p_j).
///
/// A gradient g and a Hessian H in u become Vᵀ g and Vᵀ H V in q. V rotates with body j. Along a
/// motion with dθ_j = ω the rates are therefore
///
///   of Vᵀ g:    Vᵀ (ġ + Ωᵀ g),
///   of Vᵀ H V:  Vᵀ (Ḣ + Ωᵀ H + H Ω) V,
///
/// with Ω = -ω E on the first two coordinates and zero elsewhere.
template <class T>
struct PairFrame {
  Turn<T> frame;   // θ_j
  Turn<T> across;  // θ_i - θ_j
  Vec2<T> offset;  // R(θ_j)ᵀ (t_i - t_j) [m]
  T turn;          // θ_i - θ_j [rad]

  PairFrame(const T* pi, const Turn<T>& i, const T* pj, const Turn<T>& j)
      : frame(j), across{i.c * j.c + i.s * j.s, i.s * j.c - i.c * j.s}, turn(pi[2] - pj[2]) {
    const T x = pi[0] - pj[0], y = pi[1] - pj[1];
    offset = {j.c * x + j.s * y, j.c * y - j.s * x};
  }

  /// Returns V y for a motion y = (`yi`, `yj`) in q. The pointer of a fixed body is null.
  Vec4<T> pushed(const T* yi, const T* yj) const {
    T x = yi ? yi[0] : T(0.0), y = yi ? yi[1] : T(0.0);
    if (yj) {
      x = x - yj[0];
      y = y - yj[1];
    }
    return {frame.c * x + frame.s * y, frame.c * y - frame.s * x, yi ? yi[2] : T(0.0),
            yj ? yj[2] : T(0.0)};
  }

  /// Adds Vᵀ g to (`into_i`, `into_j`). The pointer of a fixed body is null.
  void pull(const Vec4<T>& g, T* into_i, T* into_j) const {
    const T x = frame.c * g[0] - frame.s * g[1], y = frame.s * g[0] + frame.c * g[1];
    if (into_i) {
      into_i[0] = into_i[0] + x;
      into_i[1] = into_i[1] + y;
      into_i[2] = into_i[2] + g[2];
    }
    if (into_j) {
      into_j[0] = into_j[0] - x;
      into_j[1] = into_j[1] - y;
      into_j[2] = into_j[2] + g[3];
    }
  }
};

/// The four 3 × 3 blocks of Vᵀ H W for bodies i and j. V is the matrix of the frame `rows`, W that
/// of the frame `columns`. In mixed derivatives `rows` is the frame after a sub-step, `columns` the
/// frame before it.
template <class T>
struct PulledBlocks {
  Block<T> ii, ij, ji, jj;

  PulledBlocks(const PairFrame<T>& rows, const Mat4<T>& H, const PairFrame<T>& columns) {
    const Turn<T>&a = rows.frame, &b = columns.frame;
    // Rows rotated by R(a), then columns by R(b).
    Mat4<T> G = H;
    for (int m = 0; m < 4; ++m) {
      G(0, m) = a.c * H(0, m) - a.s * H(1, m);
      G(1, m) = a.s * H(0, m) + a.c * H(1, m);
    }
    Mat4<T> K = G;
    for (int m = 0; m < 4; ++m) {
      K(m, 0) = b.c * G(m, 0) - b.s * G(m, 1);
      K(m, 1) = b.s * G(m, 0) + b.c * G(m, 1);
    }
    ii << K(0, 0), K(0, 1), K(0, 2), K(1, 0), K(1, 1), K(1, 2), K(2, 0), K(2, 1), K(2, 2);
    ij << -K(0, 0), -K(0, 1), K(0, 3), -K(1, 0), -K(1, 1), K(1, 3), -K(2, 0), -K(2, 1), K(2, 3);
    ji << -K(0, 0), -K(0, 1), -K(0, 2), -K(1, 0), -K(1, 1), -K(1, 2), K(3, 0), K(3, 1), K(3, 2);
    jj << K(0, 0), K(0, 1), -K(0, 3), K(1, 0), K(1, 1), -K(1, 3), -K(3, 0), -K(3, 1), K(3, 3);
  }
};

/// Returns Ωᵀ g of a frame that turns at `rate` ω; see PairFrame.
template <class T>
Vec4<T> frame_turn(const T& rate, const Vec4<T>& g) {
  return {-rate * g[1], rate * g[0], T(0.0), T(0.0)};
}
/// Returns Ωᵀ H of a frame that turns at `rate` ω. For a symmetric H, the transpose of the result
/// is H Ω.
template <class T>
Mat4<T> row_turn(const T& rate, const Mat4<T>& H) {
  Mat4<T> out = Mat4<T>::Constant(T(0.0));
  for (int m = 0; m < 4; ++m) {
    out(0, m) = -rate * H(1, m);
    out(1, m) = rate * H(0, m);
  }
  return out;
}

}  // namespace rtg::energy
