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

  /// The sub-step begins at `now` with normal forces `lag`. With inertia `before` are the poses a
  /// sub-step earlier, null where everything is at rest. Placements must outlive the calls below.
  void begin(const Placement<T>& now, const T* lag, const Placement<T>* before = nullptr);

  /// Its value, infinite where a gap is not open; `gaps` [contacts]; `legal`: where they keep
  /// enough of what they `were` and bodies are separated.
  T value(const Placement<T>& next, const T* were, T* gaps, Mask<T>& legal) const;

  /// Adds its gradient [3·movable] and Hessian, the lower half.
  void model(const Placement<T>& next, T* gradient, BlockMatrix<T>& hessian) const;

 private:
  /// A contact that drags.
  struct Lagged {
    Vec2<T> x, normal;  // before
    T load;             // μ_f λ
    bool drags = false;
  };
  T motion(const Placement<T>& next) const;
  void add_motion(const Placement<T>& next, T* gradient, BlockMatrix<T>& hessian) const;
  Vec3<T> way_before(int body) const;
  void add_contact(const Touch<T>& touch, const Lagged& lagged, Vec4<T>& slope, Mat4<T>& H) const;

  const SceneModel<T>& scene_;
  const Placement<T>*now_ = nullptr, *before_ = nullptr;
  std::vector<Lagged> lagged_;
  std::vector<char> drags_;  // per pair
};

}  // namespace rtg::energy
