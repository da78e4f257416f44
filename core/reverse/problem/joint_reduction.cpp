#include "core/reverse/problem/joint_reduction.hpp"

#include "core/energy/joint_step.hpp"

namespace rtg::reverse {
namespace {

/// A step of reduce_joints(): applies one joint at one level k (the poses after sub-step k).
template <class T>
class JointReduction {
 public:
  using Stage = typename StageSystem<T>::Stage;

  JointReduction(const PoseSystem<T>& poses, const energy::JointStep<T>& step, int k)
      : poses_(poses), step_(step), stage_(poses.system.stages[k]), k_(k) {}

  /// Applies the joint to the system. `w` holds the multipliers of the level [3·movable].
  void apply(const T* w, const LimitTerms<T>& limits) {
    const T* gradient = poses_.gradient[k_][0].data();
    step_.gather_both(stage_.Q);
    step_.add_curvature(gradient, poses_.lagrangian, stage_.Q);
    for (BlockColumn<T>* v : {&poses_.gradient[k_], &stage_.q}) step_.gather((*v)[0].data());
    if (k_ > 0) {
      step_.gather_columns(stage_.E);
      for (BlockMatrix<T>* M : {&stage_.N, &stage_.U}) step_.gather_rows(*M);
      add_rates(w);
      for (BlockMatrix<T>* M : {&stage_.E, &stage_.F, &stage_.G}) step_.gather_rows(*M);
      step_.fill_unused(stage_.E);
      step_.add_curvature(poses_.residual[k_][0].data(), T(1.0), stage_.E);
    }
    gather_later_columns();
    for (BlockColumn<T>* v : {&poses_.residual[k_], &stage_.e}) step_.gather((*v)[0].data());
    add_limits(limits);
  }

 private:
  void add_limits(const LimitTerms<T>& terms) {
    step_.add_force(terms.gradient, poses_.gradient[k_][0].data());
    step_.add_force(terms.residual, poses_.residual[k_][0].data());
    step_.add_force(terms.q, stage_.q[0].data());
    step_.add_force(terms.e, stage_.e[0].data());
    step_.add_stiffness(terms.Q, stage_.Q);
    if (k_ > 0) step_.add_stiffness(terms.E, stage_.E);
  }

  /// Adds the terms in D = ∂w/∂q. For a parent i and a child j, w_j depends on θ_i and on the
  /// child's coordinate. The second derivatives ∂²w_j are those of t_j (JointStep) with E ∂w_j/∂q
  /// in place of E ∂t_j/∂q.
  ///
  /// Q, N, U and the columns of E are those of the new coordinates already; the rows of E, F and G,
  /// Φ and e are those of the old ones.
  void add_rates(const T* w) {
    rates_ = step_.multiplier_rates(w);
    const Vec3<T>&phi = poses_.residual[k_][step_.child()], &e = stage_.e[step_.child()];
    add_symmetric_rate_rows();
    add_rate_rows(stage_.F, stage_.N);
    add_rate_rows(stage_.G, stage_.U);
    if (step_.slot() >= 0) {
      add_rate(step_.child(), step_.slot(), rates_.by_child, phi, e);
      step_.add_child_curvature(poses_.lagrangian * across(rates_.by_child, phi), stage_.Q);
    }
    if (!step_.parent_is_movable()) return;
    add_rate(step_.parent(), 2, rates_.by_parent, phi, e);
    stage_.Q.at(step_.parent(), step_.parent())(2, 2) +=
        poses_.lagrangian * across(rates_.by_parent, phi);
  }

  /// Returns E v·Φ, where E turns by +90°.
  static T across(const Vec2<T>& v, const Vec3<T>& phi) { return v.x() * phi[1] - v.y() * phi[0]; }

  /// Adds the contribution of a coordinate, an entry of `body`, to Dᵀ Φ and Dᵀ e. `rate` is its
  /// ∂w_j/∂q.
  void add_rate(int body, int entry, const Vec2<T>& rate, const Vec3<T>& phi, const Vec3<T>& e) {
    poses_.gradient[k_][body][entry] += rate.x() * phi[0] + rate.y() * phi[1];
    stage_.q[body][entry] += poses_.lagrangian * (rate.x() * e[0] + rate.y() * e[1]);
  }

  /// Calls add(body, Z) with each row Z of Dᵀ X, for a block X of row j.
  template <class F>
  void for_each_rate_row(const Block<T>& X, F add) const {
    if (step_.slot() >= 0) add(step_.child(), rate_row(X, step_.slot(), rates_.by_child));
    if (step_.parent_is_movable()) add(step_.parent(), rate_row(X, 2, rates_.by_parent));
  }

  /// into ← into + Dᵀ from.
  void add_rate_rows(const BlockMatrix<T>& from, BlockMatrix<T>& into) {
    for (const int m : Bits(from.pattern[static_cast<std::size_t>(step_.child())]))
      for_each_rate_row(from.at(step_.child(), m),
                        [&](int body, const Block<T>& Z) { into.add(body, m, Z); });
  }

  /// Q ← Q + Dᵀ E + (Dᵀ E)ᵀ.
  void add_symmetric_rate_rows() {
    for (const int m : Bits(stage_.E.pattern[static_cast<std::size_t>(step_.child())]))
      for_each_rate_row(stage_.E.at(step_.child(), m), [&](int body, const Block<T>& Z) {
        stage_.Q.add(body, m, Z);
        stage_.Q.add(m, body, Z.transpose());
      });
  }

  Block<T> rate_row(const Block<T>& from, int entry, const Vec2<T>& rate) const {
    Block<T> Z = Block<T>::Constant(T(0.0));
    for (int m = 0; m < 3; ++m)
      Z(entry, m) = poses_.lagrangian * (rate.x() * from(0, m) + rate.y() * from(1, m));
    return Z;
  }

  /// Applies the joint to the columns of p_k in the stages of sub-steps k + 1 and k + 2.
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
  const energy::JointStep<T>& step_;
  Stage& stage_;
  int k_;
  typename energy::JointStep<T>::Rates rates_;
};

}  // namespace

template <class T>
void reduce_joints(const ProblemLanes<T>& problem, const Trajectory<T>& x,
                   const PoseSystem<T>& poses) {
  const energy::Articulation<T>& articulation = problem.energy.articulation();
  const auto& joints = articulation.joints();
  for (int k = 0; k <= poses.system.h; ++k) {
    energy::mirror_lower(poses.system.stages[k].Q);
    energy::mirror_lower(poses.system.stages[k].E);
    for (std::size_t n = joints.size(); n-- > 0;) {
      const energy::JointStep<T> step(articulation, joints[n], x.p[k]);
      JointReduction<T>(poses, step, k).apply(x.multipliers[k].data(), poses.limits[k][n]);
    }
  }
}

template void reduce_joints(const ProblemLanes<double>&, const Trajectory<double>&,
                            const PoseSystem<double>&);
template void reduce_joints(const ProblemLanes<Lanes>&, const Trajectory<Lanes>&,
                            const PoseSystem<Lanes>&);

}  // namespace rtg::reverse
