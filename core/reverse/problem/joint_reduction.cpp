#include "core/reverse/problem/joint_reduction.hpp"

#include "core/energy/hinge_step.hpp"

namespace rtg::reverse {
namespace {

/// A step of reduce_joints(): applies one hinge at one level k (the poses after sub-step k).
template <class T>
class HingeReduction {
 public:
  using Stage = typename StageSystem<T>::Stage;

  HingeReduction(const PoseSystem<T>& poses, const energy::HingeStep<T>& step, int k)
      : poses_(poses), step_(step), stage_(poses.system.stages[k]), k_(k) {}

  /// Applies the hinge to the system. `y` holds the multipliers of the level [3·movable].
  void apply(const T* y) {
    if (k_ > 0) add_rates(y);
    step_.gather_both(stage_.Q);
    step_.add_curvature(poses_.gradient[k_][0].data(), poses_.lagrangian, stage_.Q);
    if (k_ > 0) {
      step_.gather_both(stage_.E);
      step_.add_curvature(poses_.residual[k_][0].data(), T(1.0), stage_.E);
      for (BlockMatrix<T>* M : {&stage_.F, &stage_.N, &stage_.G, &stage_.U}) step_.gather_rows(*M);
    }
    gather_later_columns();
    for (BlockColumn<T>* v : {&poses_.gradient[k_], &poses_.residual[k_], &stage_.q, &stage_.e})
      step_.gather((*v)[0].data());
  }

 private:
  /// Adds the terms in D = ∂w/∂q. For a parent i and child j, w_j depends on the angles of both,
  ///   ∂w_j/∂θ_i = -A y_θi, ∂w_j/∂θ_j = B y_θj.
  void add_rates(const T* y) {
    by_child_ = step_.arms().b * y[3 * step_.child() + 2];
    by_parent_ = step_.parent_is_movable() ? Vec2<T>(step_.arms().a * -y[3 * step_.parent() + 2])
                                           : Vec2<T>(T(0.0), T(0.0));
    const Vec3<T> phi = poses_.residual[k_][step_.child()];
    const Vec3<T> e = stage_.e[step_.child()];
    add_symmetric_rate_rows();
    add_rate_rows(stage_.F, stage_.N);
    add_rate_rows(stage_.G, stage_.U);
    add_rate(step_.child(), by_child_, phi, e);
    if (step_.parent_is_movable()) add_rate(step_.parent(), by_parent_, phi, e);
  }

  /// Adds the contribution of the angle θ of `body` to Dᵀ Φ, Dᵀ e and Σ Φ ∂²w/∂θ². `rate` is
  /// ∂w_j/∂θ. The last term equals Φ·(E ∂w/∂θ), where E turns by +90°.
  void add_rate(int body, const Vec2<T>& rate, const Vec3<T>& phi, const Vec3<T>& e) {
    const T slope = rate.x() * phi[0] + rate.y() * phi[1];
    poses_.gradient[k_][body][2] += slope;
    stage_.q[body][2] += poses_.lagrangian * (rate.x() * e[0] + rate.y() * e[1]);
    stage_.Q.at(body, body)(2, 2) += poses_.lagrangian * (rate.x() * phi[1] - rate.y() * phi[0]);
  }

  /// into ← into + Dᵀ from.
  void add_rate_rows(const BlockMatrix<T>& from, BlockMatrix<T>& into) {
    for (const int m : Bits(from.pattern[static_cast<std::size_t>(step_.child())])) {
      into.add(step_.child(), m, rate_row(from.at(step_.child(), m), by_child_));
      if (step_.parent_is_movable())
        into.add(step_.parent(), m, rate_row(from.at(step_.child(), m), by_parent_));
    }
  }

  /// Q ← Q + Dᵀ E + (Dᵀ E)ᵀ.
  void add_symmetric_rate_rows() {
    const auto add = [this](int body, int m, const Block<T>& Z) {
      stage_.Q.add(body, m, Z);
      stage_.Q.add(m, body, Z.transpose());
    };
    for (const int m : Bits(stage_.E.pattern[static_cast<std::size_t>(step_.child())])) {
      const Block<T>& from = stage_.E.at(step_.child(), m);
      add(step_.child(), m, rate_row(from, by_child_));
      if (step_.parent_is_movable()) add(step_.parent(), m, rate_row(from, by_parent_));
    }
  }

  Block<T> rate_row(const Block<T>& from, const Vec2<T>& rate) const {
    Block<T> Z = Block<T>::Constant(T(0.0));
    for (int m = 0; m < 3; ++m)
      Z(2, m) = poses_.lagrangian * (rate.x() * from(0, m) + rate.y() * from(1, m));
    return Z;
  }

  /// Applies the hinge to the columns of p_k in the stages of sub-steps k + 1 and k + 2.
  void gather_later_columns() {
    auto& stages = poses_.system.stages;
    if (k_ + 1 <= poses_.system.h) {
      step_.gather_columns(stages[k_ + 1].F);
      step_.gather_columns(stages[k_ + 1].N);
    }
    if (k_ + 2 <= poses_.system.h) {
      step_.gather_columns(stages[k_ + 2].G);
      step_.gather_columns(stages[k_ + 2].U);
    }
  }

  const PoseSystem<T>& poses_;
  const energy::HingeStep<T>& step_;
  Stage& stage_;
  int k_;
  Vec2<T> by_child_, by_parent_;  // ∂w_j/∂θ_j, ∂w_j/∂θ_i
};

}  // namespace

template <class T>
void reduce_joints(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                   const PoseSystem<T>& poses) {
  const energy::Articulation<T>& articulation = problem.energy.articulation();
  const auto& hinges = articulation.hinges();
  for (int k = 0; k <= poses.system.h; ++k) {
    energy::mirror_lower(poses.system.stages[k].Q);
    energy::mirror_lower(poses.system.stages[k].E);
    for (auto hinge = hinges.rbegin(); hinge != hinges.rend(); ++hinge) {
      const energy::HingeStep<T> step(articulation, *hinge, x.p[k]);
      HingeReduction<T>(poses, step, k).apply(x.multipliers[k].data());
    }
  }
}

template void reduce_joints(const ProblemLanes<double>&, const Trajectory<double>&,
                            const PoseSystem<double>&);
template void reduce_joints(const ProblemLanes<Lanes>&, const Trajectory<Lanes>&,
                            const PoseSystem<Lanes>&);

}  // namespace rtg::reverse
