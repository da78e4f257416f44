#pragma once

#include "core/math/stage_system.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// A Newton system over the poses p of all bodies, on its way to one over the coordinates q of
/// jointed ones (Articulation).
template <class T>
struct PoseSystem {
  StageSystem<T>& system;                 // q and e without the next two
  std::vector<BlockColumn<T>>& gradient;  // of the Lagrangian [h + 1][bodies]
  std::vector<BlockColumn<T>>& residual;  // Φ_k [h + 1][bodies]
  T exact;                                // as in Curvature
};

/// Turns the one into the other. The constraints are Jᵀ Φ_k = 0, J = ∂p_k/∂q_k, and the Lagrangian
/// is that of the multipliers w = J y; with D = ∂w/∂q at fixed y,
///
///   E ← Jᵀ E J + Σ Φ ∂²p/∂q²,  F ← Jᵀ F J₋,  G ← Jᵀ G J₌,  e ← Jᵀ e
///   Q ← Jᵀ Q J + Dᵀ E J + (Dᵀ E J)ᵀ + Σ ∇L ∂²p/∂q² + Σ Φ ∂²w/∂q²
///   N ← Jᵀ N J₋ + Dᵀ F J₋,  U ← Jᵀ U J₌ + Dᵀ G J₌,  ∇L ← Jᵀ ∇L + Dᵀ Φ
///
/// hinge by hinge from the leaves on. Entries that belong to no coordinate make an identity in Q
/// and E and are zero elsewhere, so that their steps are zero.
template <class T>
void reduce_joints(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                   const PoseSystem<T>& poses);

}  // namespace rtg::reverse
