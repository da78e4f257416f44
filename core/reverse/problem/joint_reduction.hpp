#pragma once

#include "core/math/stage_system.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// A Newton system over the poses p of all bodies, which reduce_joints() turns into one over the
/// coordinates q (Articulation).
template <class T>
struct PoseSystem {
  StageSystem<T>& system;                 // its q and e without the next two
  std::vector<BlockColumn<T>>& gradient;  // of the Lagrangian [h + 1][bodies]
  std::vector<BlockColumn<T>>& residual;  // Φ_k [h + 1][bodies]
  T exact;                                // as in Curvature
};

/// Turns a system over poses into the system over coordinates, in place. The constraints become
/// Jᵀ Φ_k = 0 with J = ∂p_k/∂q_k; the multipliers in the Lagrangian become w = J y. With D = ∂w/∂q
/// at fixed y, and J₋ and J₌ those of levels k - 1 and k - 2,
///
///   E ← Jᵀ E J + Σ Φ ∂²p/∂q²,  F ← Jᵀ F J₋,  G ← Jᵀ G J₌,  e ← Jᵀ e
///   Q ← Jᵀ Q J + Dᵀ E J + (Dᵀ E J)ᵀ + Σ ∇L ∂²p/∂q² + Σ Φ ∂²w/∂q²
///   N ← Jᵀ N J₋ + Dᵀ F J₋,  U ← Jᵀ U J₌ + Dᵀ G J₌,  ∇L ← Jᵀ ∇L + Dᵀ Φ
///
/// The hinges are applied one by one, from the leaves to the roots. Entries that belong to no
/// coordinate form an identity in Q and E and are zero elsewhere, so that their steps are zero.
template <class T>
void reduce_joints(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                   const PoseSystem<T>& poses);

}  // namespace rtg::reverse
