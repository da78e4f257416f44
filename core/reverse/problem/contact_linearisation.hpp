#pragma once

#include "core/energy/gap_terms.hpp"
#include "core/energy/scatter.hpp"
#include "core/energy/slip_terms.hpp"
#include "core/energy/vertex_contact.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

inline constexpr double kForceProximal = 0.01;  // proximal weight of the forces, as a share of δ

/// Selects the Hessian of the Newton system and its proximal term, per lane.
template <class T>
struct Curvature {
  T lagrangian;  // 1: Hessian of the Lagrangian; 0: of the objective alone
  T proximal;    // δ, weight on poses and controls; kForceProximal δ on forces
  T start;       // of the barrier at the start: 1: its Hessian; 0: the convex part of it alone
};

/// The step of a normal force that was eliminated from the Newton system: Δλ = a + b·V Δp. V maps
/// poses to the coordinates of the pair of bodies (PairFrame).
template <class T>
struct Eliminated {
  T a = T(0.0);
  Vec4<T> b = Vec4<T>::Constant(T(0.0));
};

/// The terms that the contacts of a pair of bodies add to Q, E, q and e of one stage of the Newton
/// system. All are in the coordinates of the pair (PairFrame).
template <class T>
struct PairTerms {
  Mat4<T> Q = Mat4<T>::Constant(T(0.0)), E = Q;  // Hessian of the Lagrangian, ∂Φ/∂p
  Vec4<T> gradient = Vec4<T>::Constant(T(0.0));  // of the Lagrangian
  Vec4<T> residual = gradient;                   // Φ
  Vec4<T> q = gradient, e = gradient;  // without gradient and residual, which NewtonSystem adds
};

/// Linearises the contacts of a pair of bodies at level k: the poses after sub-step k, or the start
/// if k = 0. The terms are
///
///   - the normal forces in Φ_k and the friction in Φ_{k+1},
///   - the complementarity rows of level k,
///   - at the start, the barrier in the objective.
template <class T>
class ContactLinearisation {
 public:
  ContactLinearisation(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                       const Curvature<T>& curvature, int level, int pair);

  /// Returns whether any contact of the pair may act. Otherwise add() has nothing to add.
  bool relevant() const { return relevant_; }

  /// Adds the terms of the contact of `vertex` and writes its force step to `eliminated`. Returns
  /// whether the contact acts in any lane.
  bool add(int vertex, Eliminated<T>& eliminated);

  const energy::PairFrame<T>& frame() const { return here_; }
  const energy::PairFrame<T>& frame_ahead() const { return ahead_; }

  PairTerms<T> own, next;                        // for stages k and k + 1
  Mat4<T> F = Mat4<T>::Constant(T(0.0)), N = F;  // ∂Φ_{k+1}/∂p_k, ∂²L/∂p_{k+1}∂p_k

 private:
  /// The contact that add() is adding.
  struct Contact {
    const energy::VertexContact<T>& geometry;
    const SignedDistance<T>& d;
    const Mat2<T>& D;
    const energy::GapTerms<T>& gap;
    T g, r, force;  // r of the complementarity row λ r = μ̃ w: g, at the start g + g_s
    Vec4<T> b;
    T a;
    T force_gradient = T(0.0);                // ∂L/∂λ without the complementarity row
    Vec4<T> now = Vec4<T>::Constant(T(0.0));  // ∂²L/∂λ∂p_k
  };
  void add_start_barrier(const Contact& c);
  void add_normal_force(Contact& c);
  void add_friction(Contact& c, const energy::ContactPoint<T>& after);
  void add_complementarity(const Contact& c, const T& s, const T& bend);

  const energy::SceneModel<T>& scene_;
  const Curvature<T>& curvature_;
  int pair_;
  bool first_, last_, poses_fixed_;  // of this level
  const T* forces_;
  Mask<T> close_;
  bool relevant_;
  energy::PairFrame<T> here_, ahead_;
  Vec4<T> y_, y_next_;  // V y_k, V y_{k+1}
};

}  // namespace rtg::reverse
