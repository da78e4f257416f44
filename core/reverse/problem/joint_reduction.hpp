#pragma once

#include "core/math/stage_system.hpp"
#include "core/reverse/problem/limit_linearisation.hpp"
#include "core/reverse/problem/problem_lanes.hpp"

namespace rtg::reverse {

/// Newton system over the poses of all bodies, the input of reduce_joints().
template <class T>
struct PoseSystem {
  StageSystem<T>& system;                 // its q lacks `gradient`, its e lacks `residual`
  std::vector<BlockColumn<T>>& gradient;  // of the Lagrangian [h + 1][bodies]
  std::vector<BlockColumn<T>>& residual;  // Φ_k [h + 1][bodies]
  const std::vector<std::vector<LimitTerms<T>>>& limits;  // [h + 1][joints]
  T lagrangian;                                           // as in Curvature
};

/// Turns a Newton system over poses p into one over reduced coordinates q (Articulation), in place.
/// The constraints become Jᵀ Φ_k = 0 with J = ∂p_k/∂q_k. Their multipliers y enter the Lagrangian
/// as w = J y. Let D = ∂w/∂q at fixed y. J₋ and J₌ are the matrices J of sub-steps k - 1 and k - 2.
///
///   E ← Jᵀ E J + Σ Φ ∂²p/∂q²,  F ← Jᵀ F J₋,  G ← Jᵀ G J₌,  e ← Jᵀ e
///   Q ← Jᵀ Q J + Dᵀ E J + (Dᵀ E J)ᵀ + Σ ∇L ∂²p/∂q² + Σ Φ ∂²w/∂q²
///   N ← Jᵀ N J₋ + Dᵀ F J₋,  U ← Jᵀ U J₌ + Dᵀ G J₌,  ∇L ← Jᵀ ∇L + Dᵀ Φ
///
/// The joints are applied one by one, from the leaves to the roots, each with the terms of its
/// limits, which are those of its value. The rows of entries that belong to no coordinate are those
/// of the identity in Q and E and zero elsewhere, so that their steps are zero.
template <class T>
void reduce_joints(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                   const PoseSystem<T>& poses);

}  // namespace rtg::reverse
