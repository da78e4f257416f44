#include "core/reverse/problem/problem_lanes.hpp"

#include <algorithm>

namespace rtg::reverse {

template <class T>
ProblemLanes<T>::ProblemLanes(const ReverseProblem& like)
    : energy(energy::SceneModel<T>::room_for(like.energy.scene())),
      config(like.config),
      end(static_cast<std::size_t>(like.end.size()), T(0.0)),
      direction(T(0.0), T(0.0)),
      pace(1.0),
      sub_steps(like.sub_steps),
      settling(like.settling) {}

template <class T>
void ProblemLanes<T>::load(int lane, const ReverseProblem& one) {
  energy.load(lane, one.energy.scene());
  for (std::size_t m = 0; m < end.size(); ++m)
    set_lane(end[m], lane, one.end[static_cast<Eigen::Index>(m)]);
  for (int m = 0; m < 2; ++m) set_lane(direction[m], lane, one.direction[m]);
  set_lane(pace, lane, one.pace);
}

template <class T>
Vec3<T> ProblemLanes<T>::robot_path(int k) const {
  const T back = pace * T(energy.stride() * std::max(sub_steps - settling - k, 0));
  return {end[0] - back * direction.x(), end[1] - back * direction.y(), end[2]};
}

template <class T>
SpeedPenalty<T> ProblemLanes<T>::speed(const Trajectory<T>& x, int k, int i) const {
  const T *after = x.p[k].body(i), *before = x.p[k - 1].body(i);
  return {config.speed_weight,
          energy.stride(),
          energy.damping(i),
          {after[0] - before[0], after[1] - before[1], after[2] - before[2]}};
}

template <class T>
Trajectory<T>::Trajectory(const energy::SceneModel<T>& energy, int sub_steps)
    : p(static_cast<std::size_t>(sub_steps) + 1, energy::Placement<T>(energy.bodies())),
      forces(p.size(), std::vector<T>(static_cast<std::size_t>(energy.contacts()), T(0.0))),
      controls(p.size(), Vec3<T>::Constant(T(0.0))),
      multipliers(p.size(),
                  std::vector<T>(3 * static_cast<std::size_t>(energy.movable()), T(0.0))) {}

template <class T>
void Trajectory<T>::load(int lane, const ReverseProblem& problem, const Iterate& x) {
  for (std::size_t k = 0; k < p.size(); ++k) {
    for (std::size_t m = 0; m < p[k].p.size(); ++m)
      set_lane(p[k].p[m], lane, x.p[k][static_cast<Eigen::Index>(m)]);
    p[k].update();
    const std::vector<double> lambda = problem.energy.to_contact_index(x.forces[k]);
    for (std::size_t c = 0; c < lambda.size(); ++c) set_lane(forces[k][c], lane, lambda[c]);
    for (int m = 0; m < 3; ++m) set_lane(controls[k][m], lane, x.controls[k][m]);
    for (std::size_t m = 0; m < multipliers[k].size(); ++m)
      set_lane(multipliers[k][m], lane, x.multipliers[k][static_cast<Eigen::Index>(m)]);
  }
}

template <class T>
Iterate Trajectory<T>::unload(int lane, const ReverseProblem& problem) const {
  Iterate x = static_iterate(problem);
  std::vector<double> lambda(forces[0].size());
  for (std::size_t k = 0; k < p.size(); ++k) {
    for (std::size_t m = 0; m < p[k].p.size(); ++m)
      x.p[k][static_cast<Eigen::Index>(m)] = rtg::lane(p[k].p[m], lane);
    for (std::size_t c = 0; c < lambda.size(); ++c) lambda[c] = rtg::lane(forces[k][c], lane);
    x.forces[k] = problem.energy.from_contact_index(lambda);
    for (int m = 0; m < 3; ++m) x.controls[k][m] = rtg::lane(controls[k][m], lane);
    for (std::size_t m = 0; m < multipliers[k].size(); ++m)
      x.multipliers[k][static_cast<Eigen::Index>(m)] = rtg::lane(multipliers[k][m], lane);
  }
  return x;
}

template <class T>
void Trajectory<T>::copy_lane(int lane, const Trajectory& other, int from) {
  const auto copy = [lane, from](T& to, const T& one) { set_lane(to, lane, rtg::lane(one, from)); };
  for (std::size_t k = 0; k < p.size(); ++k) {
    for (std::size_t m = 0; m < p[k].p.size(); ++m) copy(p[k].p[m], other.p[k].p[m]);
    for (std::size_t i = 0; i < p[k].turns.size(); ++i) {
      copy(p[k].turns[i].c, other.p[k].turns[i].c);
      copy(p[k].turns[i].s, other.p[k].turns[i].s);
    }
    for (std::size_t c = 0; c < forces[k].size(); ++c) copy(forces[k][c], other.forces[k][c]);
    for (int m = 0; m < 3; ++m) copy(controls[k][m], other.controls[k][m]);
    for (std::size_t m = 0; m < multipliers[k].size(); ++m)
      copy(multipliers[k][m], other.multipliers[k][m]);
  }
}

template <class T>
void Trajectory<T>::assign(const Mask<T>& where, const Trajectory& other) {
  const auto blend = [&where](T& to, const T& one) { to = select(where, one, to); };
  for (std::size_t k = 0; k < p.size(); ++k) {
    p[k].assign(where, other.p[k]);
    for (std::size_t c = 0; c < forces[k].size(); ++c) blend(forces[k][c], other.forces[k][c]);
    for (int m = 0; m < 3; ++m) blend(controls[k][m], other.controls[k][m]);
    for (std::size_t m = 0; m < multipliers[k].size(); ++m)
      blend(multipliers[k][m], other.multipliers[k][m]);
  }
}

template struct ProblemLanes<double>;
template struct ProblemLanes<Lanes>;
template struct Trajectory<double>;
template struct Trajectory<Lanes>;

}  // namespace rtg::reverse
