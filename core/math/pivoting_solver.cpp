#include "core/math/pivoting_solver.hpp"

namespace rtg {
namespace {

template <class From, class To>
void copy_entries(const From& from, int l, To& to) {
  for (Eigen::Index k = 0; k < from.size(); ++k) to.data()[k] = lane(from.data()[k], l);
}

template <class T>
void copy_lane(const BlockMatrix<T>& from, int l, BlockMatrix<double>& to) {
  to.pattern = from.pattern;
  for (std::size_t k = 0; k < from.blocks.size(); ++k)
    copy_entries(from.blocks[k], l, to.blocks[k]);
}

template <class T>
void copy_lane(const BlockColumn<T>& from, int l, BlockColumn<double>& to) {
  for (std::size_t i = 0; i < from.size(); ++i) copy_entries(from[i], l, to[i]);
}

/// Returns the system of lane l.
template <class T>
StageSystem<double> of_lane(const StageSystem<T>& system, int l) {
  StageSystem<double> one(system.M, system.h);
  for (std::size_t k = 0; k < system.stages.size(); ++k) {
    const auto& from = system.stages[k];
    auto& to = one.stages[k];
    copy_lane(from.Q, l, to.Q);
    copy_lane(from.E, l, to.E);
    copy_lane(from.F, l, to.F);
    copy_lane(from.G, l, to.G);
    copy_lane(from.N, l, to.N);
    copy_lane(from.U, l, to.U);
    copy_lane(from.q, l, to.q);
    copy_lane(from.e, l, to.e);
    copy_entries(from.R, l, to.R);
    copy_entries(from.B, l, to.B);
    copy_entries(from.r, l, to.r);
  }
  return one;
}

template <class T>
void set_entries(Vec3<T>& to, int l, const Vec3<double>& from) {
  for (int m = 0; m < 3; ++m) set_lane(to[m], l, from[m]);
}

template <class T>
void set_step(StageStep<T>& to, int l, const StageStep<double>& from) {
  for (std::size_t k = 0; k < from.poses.size(); ++k) {
    set_entries(to.controls[k], l, from.controls[k]);
    for (std::size_t i = 0; i < from.poses[k].size(); ++i) {
      set_entries(to.poses[k][i], l, from.poses[k][i]);
      set_entries(to.multipliers[k][i], l, from.multipliers[k][i]);
    }
  }
}

}  // namespace

template <class T>
bool PivotingSolver<T>::solve(const StageSystem<T>& system, int l, StageStep<T>& step) {
  StageStep<double> one(system.M, system.h);
  if (!klu_.solve(of_lane(system, l), one)) return false;
  set_step(step, l, one);
  return true;
}

template class PivotingSolver<double>;
template class PivotingSolver<Lanes>;

}  // namespace rtg
