#pragma once

#include "core/energy/scatter.hpp"
#include "core/energy/slip_terms.hpp"
#include "core/energy/touch.hpp"

namespace rtg::energy {

/// Ψ without actuation as a function of the poses after a sub-step, eq. (8); see StepEnergy.
template <class T>
class StepPotential {
 public:
  explicit StepPotential(const SceneModel<T>& scene)
      : scene_(scene),
        lagged_(static_cast<std::size_t>(scene.contacts())),
        drags_(scene.pairs().size()) {}

  /// Begins a sub-step at poses `now` with normal forces `lag`. Inertia also uses `before`, the
  /// poses one sub-step earlier; null means that everything is at rest. The placements must outlive
  /// all calls of value() and model().
  void begin(const Placement<T>& now, const T* lag, const Placement<T>* before = nullptr);

  /// Returns Ψ without actuation, infinite in lanes where a gap is not positive. Sets `gaps`
  /// [contacts], and `legal` to the lanes in which keeps_gap() holds for each gap and its previous
  /// value in `were` [contacts] and all bodies are separated.
  T value(const Placement<T>& next, const T* were, T* gaps, Mask<T>& legal) const;

  /// Adds the gradient of value() [3·movable] and the lower half of its Hessian.
  void model(const Placement<T>& next, T* gradient, BlockMatrix<T>& hessian) const;

 private:
  /// Lagged friction of a contact.
  struct Lagged {
    Vec2<T> x, normal;   // point and normal at the start of the sub-step
    T load;              // μ_f λ
    bool drags = false;  // λ ≠ 0 in some lane; else the members above are not set
  };
  T motion(const Placement<T>& next) const;
  void add_motion(const Placement<T>& next, T* gradient, BlockMatrix<T>& hessian) const;
  Vec3<T> way_before(int body) const;
  void add_contact(const Touch<T>& touch, const Lagged& lagged, Vec4<T>& slope, Mat4<T>& H) const;

  const SceneModel<T>& scene_;
  const Placement<T>*now_ = nullptr, *before_ = nullptr;
  std::vector<Lagged> lagged_;
  std::vector<char> drags_;  // per pair: whether some contact drags
};

}  // namespace rtg::energy
