#pragma once

#include <vector>

#include "core/energy/scene_model.hpp"
#include "core/world/pose.hpp"

namespace rtg::energy {

/// A vertex of body `body` that may touch body `other`, or a limit of a joint. For a limit, `body`
/// is the child of the joint and `other` its parent.
struct Contact {
  int body = 0, other = 0;
  double friction = 0.0;  // μ_f of the pair
  int pair = 0, vertex = 0;
};

/// Start of a sub-step: the poses p [3·bodies], the normal forces at p [contacts], and the poses p₋
/// one sub-step earlier, null if everything is at rest. Only inertia uses p₋.
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
/// without I in quasi-static mode. The sums run over all contacts: each vertex of either body of a
/// pair against the other body, and the limits of joints. λ is the normal force before the
/// sub-step. ∂Ψ/∂p₊ = 0 defines the sub-step, eq. (5).
///
/// Poses are stacked as (x, y, θ) per body [3·bodies]. The first `dofs()` entries are unknowns, the
/// others belong to fixed bodies. All member functions are const and there is no mutable state, so
/// many threads may use one object.
class StepEnergy {
 public:
  /// `scene` lists its movable bodies first; body 0 is the robot.
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
  /// Returns the constants of the scene in the form that the kernels use.
  const SceneModel<double>& scene() const { return scene_; }

  /// Returns the gap g of a contact; 2 ĝ if a vertex is beyond the barrier's range.
  double gap_value(const Contact& c, const VectorXd& p) const;
  /// Returns λ(g(p)) of every contact [contacts].
  VectorXd forces(const VectorXd& p) const;

  /// Returns Ψ without actuation; +∞ if a gap is not positive.
  double value(const VectorXd& next, const StepFrom& from) const;
  struct Model {
    VectorXd gradient;  // [dofs]
    MatrixXd hessian;   // [dofs × dofs]
  };
  /// Returns the gradient and the Hessian of value() with respect to p₊. All bodies count as
  /// independent, jointed ones too.
  Model model(const VectorXd& next, const StepFrom& from) const;

  /// Returns whether all pairs of bodies pass the separating-axis test; see SeparatingEdges.
  bool separated(const VectorXd& p) const;

  /// Convert entries per contact [contacts] to the numbering of the kernels, contact_of(), and
  /// back.
  std::vector<double> spread(const VectorXd& per_contact) const;
  VectorXd gathered(const std::vector<double>& spread) const;

 private:
  SceneModel<double> scene_;
  std::vector<Contact> contacts_;
};

/// Returns stacked poses [3·bodies] in the form that the kernels use.
Placement<double> placed(const VectorXd& p);

/// Convert poses to stacked poses [3·bodies] and back.
VectorXd stacked(const Poses& poses);
Poses unstacked(const VectorXd& p);

}  // namespace rtg::energy
