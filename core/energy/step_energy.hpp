#pragma once

#include <vector>

#include "core/energy/scene_model.hpp"
#include "core/world/pose.hpp"

namespace rtg::energy {

/// A vertex of body `body` that may touch body `other`; or a limit of a joint, body its child.
struct Contact {
  int body = 0, other = 0;
  double friction = 0.0;  // μ_f of the pair
  int pair = 0, vertex = 0;
};

/// Where a sub-step begins: poses p [3·bodies], their normal forces [contacts], and the poses p₋
/// one sub-step before, of which inertia alone makes use; null: at rest.
struct StepFrom {
  const VectorXd& now;
  const VectorXd& lag;
  const VectorXd* before = nullptr;
};

/// The step energy of one scene, eq. (8), in units of k_D/Δt² (so damping has weight one and
/// energies are [kg m²]):
///
///   Ψ(p₊, p, p₋, c) = I(p₊, p, p₋) + I_D(p₊ - p) + Σ b(g(p₊)) + Σ μ_f λ φ(u(p₊, p))
///                     - B·tanh(c)·p₊₀,
///
/// in quasi-static mode without I; sums over all contacts: every vertex of either body of a pair
/// against the other. λ is the normal force before the sub-step. ∂Ψ/∂p₊ = 0 is the step, eq. (5).
///
/// Poses are stacked as (x, y, θ) per body [3·bodies]; the first `dofs()` of them are unknowns, the
/// rest belong to fixed bodies. Const and free of mutable state: may be used by many threads.
class StepEnergy {
 public:
  /// `scene`: movable bodies first, body 0 is the robot.
  StepEnergy(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push);

  int bodies() const { return scene_.bodies(); }
  int dofs() const { return 3 * scene_.movable(); }
  bool movable(int body) const { return scene_.movable(body); }
  const std::vector<Contact>& contacts() const { return contacts_; }
  const Barrier& barrier() const { return scene_.barrier(); }
  const Damping<double>& damping(int body) const { return scene_.damping(body); }
  /// (B_f, B_f, B_ω) [kg m], [kg m²].
  const Vector3d& control_bound() const { return scene_.control_bound(); }
  double stride() const { return scene_.stride(); }  // of a sub-step [m]
  /// The same in the form of the kernels.
  const SceneModel<double>& scene() const { return scene_; }

  /// g, 2 ĝ where it is beyond the barrier's range.
  double gap_value(const Contact& c, const VectorXd& p) const;
  /// λ(g(p)) of every contact [contacts].
  VectorXd forces(const VectorXd& p) const;

  /// Ψ without actuation: its value, gradient and Hessian with respect to p₊ [dofs], as if there
  /// were no joints; +∞ if a gap is not positive.
  double value(const VectorXd& next, const StepFrom& from) const;
  struct Model {
    VectorXd gradient;  // [dofs]
    MatrixXd hessian;   // [dofs × dofs]
  };
  Model model(const VectorXd& next, const StepFrom& from) const;

  /// Separating-axis test of all pairs of which one may move; see SeparatingEdges.
  bool separated(const VectorXd& p) const;

  /// Entries per contact [contacts], as the kernels number them, and back.
  std::vector<double> spread(const VectorXd& per_contact) const;
  VectorXd gathered(const std::vector<double>& spread) const;

 private:
  SceneModel<double> scene_;
  std::vector<Contact> contacts_;
};

/// Stacked poses [3·bodies] in the form of the kernels.
Placement<double> placed(const VectorXd& p);

/// Stacked poses [3·bodies] and back.
VectorXd stacked(const Poses& poses);
Poses unstacked(const VectorXd& p);

}  // namespace rtg::energy
