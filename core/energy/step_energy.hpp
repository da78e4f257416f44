#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/energy/barrier.hpp"
#include "core/energy/damping.hpp"
#include "core/energy/friction.hpp"
#include "core/energy/gap.hpp"
#include "core/world/physics_config.hpp"
#include "core/world/push.hpp"
#include "core/world/scene.hpp"

namespace rtg {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A vertex of body `body` that may touch body `other`.
struct Contact {
  int body = 0, other = 0;
  Vector2d vertex = Vector2d::Zero();  // in the frame of `body` [m]
  double friction = 0.0;               // μ_f of the pair
};

/// The quasi-static step energy, eq. (8) without inertia, in units of k_D/Δt² (so damping has
/// weight one and energies are [kg m²]):
///
///   Ψ(p₊, p, c) = I_D(p₊ - p) + Σ b(g(p₊)) + Σ μ_f λ φ(u(p₊, p)) - B·tanh(c)·p₊₀,
///
/// sums over all contacts: every vertex of either body of a pair against the other. λ is the normal
/// force before the sub-step. ∂Ψ/∂p₊ = 0 is the step, eq. (5).
///
/// Poses are stacked as (x, y, θ) per body [3·bodies]; the first `dofs()` of them are unknowns, the
/// rest belong to fixed bodies. Const and free of mutable state: may be used by many threads.
class StepEnergy {
 public:
  /// `scene`: movable bodies first, body 0 is the robot.
  StepEnergy(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push);

  int bodies() const { return static_cast<int>(planes_.size()); }
  int dofs() const { return 3 * movable_; }
  const std::vector<Contact>& contacts() const { return contacts_; }
  const Barrier& barrier() const { return barrier_; }
  const Damping& damping(int body) const { return damping_[body]; }
  /// (B_f, B_f, B_ω) [kg m], [kg m²].
  const Vector3d& control_bound() const { return control_bound_; }
  double stride() const { return stride_; }  // of a sub-step [m]

  /// Whether the two bodies are close enough for any of their contacts to act.
  bool near(const Contact& c, const VectorXd& p) const;
  bool movable(int body) const { return body < movable_; }

  template <class S>
  Gap<S> gap(const Contact& c, const LocalPoint<S>& point) const {
    return rtg::gap(planes_[c.other], sharpness_, skin_, point);
  }
  template <class S>
  GapSlope<S> gap_slope(const Contact& c, const LocalPoint<S>& point) const {
    return rtg::gap_slope(planes_[c.other], sharpness_, skin_, point);
  }
  /// g, or a lower bound of it where that is beyond the barrier's range.
  double gap_value(const Contact& c, const LocalPoint<double>& point) const;
  double gap_value(const Contact& c, const VectorXd& p) const { return gap_value(c, point(c, p)); }
  LocalPoint<double> point(const Contact& c, const VectorXd& p) const;
  /// The same point with dual parts along `y` [dofs].
  LocalPoint<Dual> point(const Contact& c, const VectorXd& p, const VectorXd& y) const;
  template <class S>
  Friction<S> friction(const Contact& c, const LocalPoint<S>& next,
                       const LocalPoint<S>& now) const {
    return rtg::friction(planes_[c.other], sharpness_, slip_, next, now);
  }
  Slip<double> slip(const Contact& c, const LocalPoint<double>& next,
                    const LocalPoint<double>& now) const {
    return {planes_[c.other], sharpness_, slip_, next, now};
  }

  /// λ(g(p)) of every contact [contacts].
  VectorXd forces(const VectorXd& p) const;

  /// Ψ without actuation: its value, gradient and Hessian with respect to p₊ [dofs]; +∞ if a gap
  /// is not positive.
  double value(const VectorXd& next, const VectorXd& now, const VectorXd& lag) const;
  struct Model {
    VectorXd gradient;  // [dofs]
    MatrixXd hessian;   // [dofs × dofs]
  };
  Model model(const VectorXd& next, const VectorXd& now, const VectorXd& lag) const;

  /// Separating-axis test of all pairs of which one may move. Corners, which the smoothed distance
  /// cuts, may overlap by 2 ln 2/α, and by as much again: acute tips pass each other without a
  /// vertex in the other body, and a wall there that no force announces would stop every solver.
  bool separated(const VectorXd& p) const;
  /// Every gap open and, below `share` of the barrier's range, ≥ `share` of what it was in
  /// `before`; and separated().
  bool keeps_gaps(const VectorXd& before, const VectorXd& after, double share) const;

 private:
  bool has_separating_edge(int i, int j, const VectorXd& p, double cut) const;
  void add_pair_contacts(const Scene& scene, int body, int other);
  void add_contact(const Contact& c, const VectorXd& next, const VectorXd& now, double lag,
                   Model& model) const;

  int movable_ = 0;
  std::vector<Contact> contacts_;
  std::vector<Polygon> shapes_;
  std::vector<HalfPlanes> planes_;
  std::vector<double> radius_;
  std::vector<Damping> damping_;
  Barrier barrier_;
  double sharpness_, skin_, slip_;
  double stride_;
  Vector3d control_bound_;
};

/// Adds M [6×6] of a contact's two bodies to the rows and columns of its movable bodies in `into`,
/// whose poses begin at row `row` and column `column`.
void scatter(const StepEnergy& energy, const Contact& c, const Mat6<double>& M,
             Eigen::Ref<MatrixXd> into);
void scatter(const StepEnergy& energy, const Contact& c, const Vec6<double>& v,
             Eigen::Ref<VectorXd> into);
/// The entries of v [dofs] of a contact's two bodies, 0 for a fixed one.
Vec6<double> gather(const StepEnergy& energy, const Contact& c, const VectorXd& v);

/// Stacked poses [3·bodies] and back.
VectorXd stacked(const Poses& poses);
Poses unstacked(const VectorXd& p);

}  // namespace rtg
