#include "core/reverse/problem/warm_start.hpp"

#include <algorithm>
#include <cmath>

#include "core/energy/open_gaps.hpp"

namespace rtg::reverse {
namespace {

constexpr double kLeastShare = 0.05;  // smaller shares of a mirrored step are not tried
constexpr double kTolerance = 1e-6;   // of a forward step [kg m]

template <class T>
void put_robot(const Vec3<T>& pose, energy::Placement<T>& at) {
  for (int m = 0; m < 3; ++m) at.p[m] = pose[m];
  at.update();
}

}  // namespace

template <class T>
WarmStart<T>::WarmStart(const ProblemLanes<T>& problem)
    : problem_(problem),
      scene_(problem.energy),
      step_(scene_, kTolerance),
      start_(scene_.bodies()),
      pushed_(start_),
      unpushed_(start_),
      robot_back_(start_),
      trial_(start_),
      forward_displacement_(start_.p),
      forces_(static_cast<std::size_t>(scene_.contacts()), T(0.0)),
      last_displacement_(start_.p) {}

/// Returns the lag of the robot's servo behind its target in steady motion [m].
template <class T>
T WarmStart<T>::servo_lead() const {
  const T share =
      scene_.damping(0).mass * problem_.pace * T(scene_.stride()) / scene_.control_bound()[0];
  const T bounded = lesser(share, T(1.0 - 1e-12));
  const T artanh = T(0.5) * logarithm((T(1.0) + bounded) / (T(1.0) - bounded));
  return select(share < T(1.0), artanh * T(energy::servo_scale(scene_.stride())), T(0.0));
}

/// Returns the target of the robot's servo in sub-step k. It is the pose on the straight path after
/// sub-step k. While the robot moves, the target leads by servo_lead().
template <class T>
Vec3<T> WarmStart<T>::straight_target(int k) const {
  Vec3<T> pose = problem_.robot_path(k);
  if (k > problem_.sub_steps - problem_.settling) return pose;
  const T lead = servo_lead();
  for (int m = 0; m < 2; ++m) pose[m] += lead * problem_.direction[m];
  return pose;
}

/// Computes the forward step `to` = F(from) with the servo at `target`. Stores the displacement in
/// last_displacement_. Returns the lanes in which it succeeded.
template <class T>
Mask<T> WarmStart<T>::push(const energy::StepStart<T>& from, const Vec3<T>& target,
                           const Mask<T>& wanted, energy::Placement<T>& to) {
  const Mask<T> found = step_.solve(from, energy::Drive<T>::towards(target), wanted, to);
  for (std::size_t m = 0; m < last_displacement_.size(); ++m)
    last_displacement_[m] = select(found, to.p[m] - from.now.p[m], last_displacement_[m]);
  return found;
}

/// Returns the lanes in which no gap of `at` is narrower than `floor`, and no bodies overlap.
template <class T>
Mask<T> WarmStart<T>::is_open(const energy::Placement<T>& at, const T& floor) const {
  return scene_.least_gap(at) >= floor && scene_.separated(at);
}

/// Sets robot_back_ to start_ with the robot at `back`. In lanes of `wanted` in which an object
/// stands there, a forward step towards `back` pushes it away.
template <class T>
void WarmStart<T>::clear_way(const Vec3<T>& back, const T& floor, const Mask<T>& wanted) {
  robot_back_ = start_;
  put_robot(back, robot_back_);
  const Mask<T> blocked = wanted && !is_open(robot_back_, floor);
  if (!any(blocked)) return;
  Vec3<T> target = back;
  const T lead = servo_lead();
  for (int m = 0; m < 2; ++m) target[m] -= lead * problem_.direction[m];
  const Mask<T> cleared =
      step_.solve({start_, forces_.data()}, energy::Drive<T>::towards(target), blocked, trial_);
  robot_back_.assign(cleared, trial_);
}

/// Sets start_ to robot_back_ with the objects moved by -share·forward_displacement_. Takes the
/// largest share of 1, ½, ¼, ... that leaves all gaps open, or 0.
template <class T>
void WarmStart<T>::move_back(const T& floor, const Mask<T>& wanted) {
  Mask<T> searching = wanted;
  for (double share = 1.0; share > kLeastShare && any(searching); share *= 0.5) {
    trial_ = robot_back_;
    for (int m = 3; m < 3 * scene_.movable(); ++m)
      trial_.p[m] = robot_back_.p[m] - T(share) * forward_displacement_[m];
    scene_.place(trial_);
    const Mask<T> open = searching && is_open(trial_, floor);
    start_.assign(open, trial_);
    searching = searching && !open;
  }
  start_.assign(searching, robot_back_);
}

/// Changes start_ from the state after sub-step k to the state before it. The robot goes to
/// mirrored_path(k - 1), the objects move by a mirrored forward step. Returns the lanes in which
/// the forward steps succeeded.
template <class T>
Mask<T> WarmStart<T>::step_back(int k, const Mask<T>& wanted) {
  const Vec3<T> here(start_.p[0], start_.p[1], start_.p[2]);
  const T step = problem_.pace * T(scene_.stride());
  const Vec3<T> stride(step * problem_.direction.x(), step * problem_.direction.y(), T(0.0));
  scene_.forces(start_, forces_.data());
  Mask<T> going =
      push({start_, forces_.data(), last_displacement_.data()}, here + stride, wanted, pushed_);
  going = step_.solve({start_, forces_.data()}, energy::Drive<T>::towards(here), going, unpushed_);
  for (std::size_t m = 0; m < forward_displacement_.size(); ++m)
    forward_displacement_[m] = pushed_.p[m] - unpushed_.p[m];
  const T floor = lesser(T(energy::kGapFloor * scene_.barrier().range), scene_.least_gap(start_));
  clear_way(mirrored_path(k - 1), floor, going);
  move_back(floor, going);
  return going;
}

template <class T>
Mask<T> WarmStart<T>::simulate(const Mask<T>& wanted, Trajectory<T>& x) {
  std::ranges::fill(last_displacement_, T(0.0));
  return roll_out(wanted, x);
}

template <class T>
Mask<T> WarmStart<T>::roll_out(const Mask<T>& wanted, Trajectory<T>& x) {
  for (std::vector<T>& y : x.multipliers) std::ranges::fill(y, T(0.0));
  scene_.forces(x.p[0], x.forces[0].data(), scene_.barrier().start_spare());
  Mask<T> going = wanted;
  for (int k = 1; k <= problem_.sub_steps; ++k) {
    const Vec3<T> target = straight_target(k);
    const energy::StepStart<T> from{x.p[k - 1], x.forces[k - 1].data(), last_displacement_.data(),
                                    &x.p[std::max(k - 2, 0)]};
    going = push(from, target, going, x.p[k]);
    x.controls[k] =
        energy::Drive<T>::towards(target).control_at(x.p[k], energy::servo_scale(scene_.stride()));
    scene_.forces(x.p[k], x.forces[k].data());
  }
  return going;
}

/// Returns the robot's pose after sub-step k on the straight path. Here the path goes on beyond its
/// end as far as objects coast.
template <class T>
Vec3<T> WarmStart<T>::mirrored_path(int k) const {
  const int beyond = k - (problem_.sub_steps - problem_.settling);
  Vec3<T> pose = problem_.robot_path(k);
  const double steps = std::min(static_cast<double>(beyond), scene_.coasting());
  for (int m = 0; m < 2 && beyond > 0; ++m)
    pose[m] += problem_.pace * T(steps * scene_.stride()) * problem_.direction[m];
  return pose;
}

/// Puts the robot of start_ at mirrored_path(k) in the lanes of `wanted` in which no body is in its
/// way. Returns these lanes.
template <class T>
Mask<T> WarmStart<T>::begin_at(int k, const Mask<T>& wanted) {
  robot_back_ = start_;
  put_robot(mirrored_path(k), robot_back_);
  const Mask<T> open =
      wanted && scene_.least_gap(robot_back_) > T(0.0) && scene_.separated(robot_back_);
  start_.assign(open, robot_back_);
  return open;
}

template <class T>
Mask<T> WarmStart<T>::find(const Mask<T>& wanted, Trajectory<T>& x) {
  std::ranges::fill(last_displacement_, T(0.0));
  start_.p = problem_.end;
  start_.update();
  // Objects coast as if a robot that goes on beyond the end of its path pushed them. So mirroring
  // begins with the robot on that longer path.
  const int stop = problem_.sub_steps - problem_.settling;
  Mask<T> going = wanted, begun(false);
  for (int k = stop + static_cast<int>(std::ceil(scene_.coasting())); k > 0 && any(going); --k) {
    begun = begun || (k <= stop ? going : begin_at(k, going && !begun));
    going = going && (step_back(k, going && begun) || !begun);
  }
  x.p[0] = start_;
  return roll_out(going, x);
}

std::optional<Iterate> warm_start(const ReverseProblem& problem) {
  ProblemLanes<double> one(problem);
  one.load(0, problem);
  Trajectory<double> x(one.energy, one.sub_steps);
  x.load(0, problem, static_iterate(problem));
  if (!WarmStart<double>(one).find(true, x)) return std::nullopt;
  return x.unload(0, problem);
}

template class WarmStart<double>;
template class WarmStart<Lanes>;

}  // namespace rtg::reverse
