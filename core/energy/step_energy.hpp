#pragma once

#include <vector>

#include "core/energy/scene_model.hpp"
#include "core/world/pose.hpp"

namespace rtg::energy {

/// A contact: a vertex of `body` that may touch `other`, or a limit of a joint. For a limit, `body`
/// is the child of the joint and `other` its parent. contact_of(`pair`, `vertex`) is the contact's
/// index in SceneModel.
struct Contact {
  int body = 0, other = 0;
  double friction = 0.0;  // μ_f of the pair
  int pair = 0, vertex = 0;
};

/// Where two bodies touch, in the world frame.
struct ContactSite {
  Vector2d point;   // on the surface of Contact::body [m]
  Vector2d normal;  // ∇d/|∇d|, away from Contact::other; a normal force acts on `body` along it
};

/// Initial data of a sub-step: the poses p (`now` [3·bodies]) and the normal forces at p
/// (`previous_forces` [contacts]). `before` are the poses p₋ one sub-step earlier, which only
/// inertia uses; null if everything is at rest.
struct StepFrom {
  const VectorXd& now;
  const VectorXd& previous_forces;
  const VectorXd* before = nullptr;
};

/// The step energy of one scene, eq. (8), whose minimum over p₊ is the sub-step, eq. (5):
///
///   Ψ(p₊, p, p₋, c) = I(p₊, p, p₋) + I_D(p₊ - p) + Σ b(g(p₊)) + Σ μ_f λ φ(u(p₊, p))
///                     - B·tanh(c)·p₊₀.
///
/// Energies are in units of k_D/Δt², so that damping has weight one and they are [kg m²]. The
/// inertia I is absent in quasi-static mode. The sums run over all contacts: the limits of joints,
/// and each vertex of either body of a pair against the other body. λ is the normal force before
/// the sub-step.
///
/// Poses are stacked as (x, y, θ) per body [3·bodies]. The first `dofs()` entries are unknowns, the
/// others belong to fixed bodies. Thread-safe: all member functions are const, without mutable
/// state.
class StepEnergy {
 public:
  /// `scene` must list its movable bodies first; body 0 is the robot.
  StepEnergy(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push);

  int bodies() const { return scene_.bodies(); }
  int dofs() const { return 3 * scene_.movable(); }
  bool movable(int body) const { return scene_.movable(body); }
  const std::vector<Contact>& contacts() const { return contacts_; }
  const Barrier& barrier() const { return scene_.barrier(); }
  const Damping<double>& damping(int body) const { return scene_.damping(body); }
  /// Returns the bounds (B_f, B_f, B_ω) of the robot's force and torque [kg m], [kg m²].
  const Vector3d& control_bound() const { return scene_.control_bound(); }
  double stride() const { return scene_.stride(); }  // of a sub-step [m]
  /// Returns the constants of the scene, as the templates of this folder use them.
  const SceneModel<double>& scene() const { return scene_; }

  /// Returns the gap g of a contact at poses `p`. Returns 2 ĝ for a vertex beyond the barrier's
  /// range.
  double gap_value(const Contact& c, const VectorXd& p) const;
  /// Returns whether a contact is the limit of a joint.
  bool is_limit(const Contact& c) const { return c.pair >= scene_.pair_count(); }
  /// Returns where a contact that is no limit acts at poses `p`.
  ContactSite site(const Contact& c, const VectorXd& p) const;
  /// Returns the normal force λ(g(p)) of every contact [contacts]; `spare` as in SceneModel.
  VectorXd forces(const VectorXd& p, double spare = 0.0) const;
  /// Returns those at the start `p` of a push, λ₀, see Barrier::start_spare().
  VectorXd start_forces(const VectorXd& p) const { return forces(p, barrier().start_spare()); }

  /// Returns Ψ without actuation; +∞ if a gap is not positive.
  double value(const VectorXd& next, const StepFrom& from) const;
  struct Model {
    VectorXd gradient;  // [dofs]
    MatrixXd hessian;   // [dofs × dofs]
  };
  /// Returns the gradient and the Hessian of value() with respect to p₊, or to the coordinates of a
  /// scene with joints (Articulation).
  Model model(const VectorXd& next, const StepFrom& from) const;

  /// Returns whether all pairs of bodies pass the separating-axis test; see SeparatingEdges.
  bool separated(const VectorXd& p) const;

  /// Reorders a vector over contacts() to the numbering of contact_of(). from_contact_index() does
  /// the reverse. Unused entries of the result are zero.
  std::vector<double> to_contact_index(const VectorXd& per_contact) const;
  VectorXd from_contact_index(const std::vector<double>& by_index) const;

 private:
  SceneModel<double> scene_;
  std::vector<Contact> contacts_;
};

/// Converts stacked poses `p` [3·bodies] to a Placement.
Placement<double> placed(const VectorXd& p);

/// Converts poses to a stacked vector [3·bodies]. unstacked() does the reverse.
VectorXd stacked(const Poses& poses);
Poses unstacked(const VectorXd& p);

}  // namespace rtg::energy
