#pragma once

#include "core/energy/scatter.hpp"
#include "core/energy/slip_terms.hpp"
#include "core/energy/vertex_contact.hpp"

namespace rtg::energy {

/// Ψ without actuation as a function of the poses after a sub-step, eq. (8); see StepEnergy.
template <class T>
class StepPotential {
 public:
  explicit StepPotential(const SceneModel<T>& scene)
      : scene_(scene),
        lagged_(static_cast<std::size_t>(scene.contacts())),
        drags_(scene.pairs().size()) {}

  /// Begins a sub-step at poses `now` with normal forces `previous_forces` [contacts]. `before` are
  /// the poses one sub-step earlier, which only inertia uses; null if everything is at rest. The
  /// placements must outlive all calls of value() and model().
  void begin(const Placement<T>& now, const T* previous_forces,
             const Placement<T>* before = nullptr);

  /// Returns Ψ without actuation at poses `next`; +∞ in lanes where a gap is not positive. Writes
  /// the gaps to `gaps` [contacts].
  ///
  /// Sets `legal` to the lanes in which a line search may accept `next`. There all bodies are
  /// separated, and is_gap_acceptable() holds for each gap. `previous_gaps` [contacts] are the gaps
  /// at the previous iterate.
  T value(const Placement<T>& next, const T* previous_gaps, T* gaps, Mask<T>& legal) const;

  /// Adds the gradient of value() to `gradient` [3·movable], and its Hessian to the lower half of
  /// `hessian`. Joints are not eliminated, and their limits are left out.
  void model(const Placement<T>& next, T* gradient, BlockMatrix<T>& hessian) const;
  /// Converts the results of model() to the coordinates of the articulation, with the limits of the
  /// joints and both halves of the Hessian. Does nothing if there are no joints.
  void reduce(const Placement<T>& next, T* gradient, BlockMatrix<T>& hessian) const;

 private:
  /// Lagged friction of a contact.
  struct Lagged {
    Vec2<T> x, normal;   // point and normal at the start of the sub-step
    T roll, load;        // of that point; μ_f λ
    bool drags = false;  // λ ≠ 0 in some lane; otherwise the members above are unset
  };
  T motion(const Placement<T>& next) const;
  void add_motion(const Placement<T>& next, T* gradient, BlockMatrix<T>& hessian) const;
  Vec3<T> previous_displacement(int body) const;
  void add_contact(const VertexContact<T>& contact, const Lagged& lagged, Vec4<T>& slope,
                   Mat4<T>& H) const;

  const SceneModel<T>& scene_;
  const Placement<T>*now_ = nullptr, *before_ = nullptr;
  std::vector<Lagged> lagged_;
  std::vector<char> drags_;  // per pair: whether some contact drags
};

}  // namespace rtg::energy
