#include "core/reverse/naive_reverse.hpp"

#include <algorithm>
#include <utility>

#include "core/math/rng.hpp"
#include "core/world/separation.hpp"

namespace rtg::reverse {
namespace {

constexpr double kTouch = 0.2;      // gap below which an object ahead counts as touched [m]
constexpr double kLeastPull = 0.2;  // least L, as a share of the stride
constexpr double kSweepStep = 0.1;  // largest distance between tested robot positions [m]

Pose moved(const Pose& p, const Vector2d& by) { return {p.x + by.x(), p.y + by.y(), p.theta}; }

}  // namespace

NaiveReverse::NaiveReverse(Scene scene, PushConfig push)
    : scene_(std::move(scene)), push_(push), roots_(moving_group_roots(scene_)) {}

/// Returns the object that the robot touches in the direction `ahead`: the nearest movable one
/// whose gap is below kTouch. Returns 0 if there is none.
std::size_t NaiveReverse::touched_object(const Poses& end, const Vector2d& ahead) const {
  std::size_t best = 0;
  double nearest = kTouch;
  const Shape& robot = scene_.bodies[0].shape;
  const Pose advanced = moved(end[0], kTouch * ahead);
  for (std::size_t k = 1; k < scene_.size(); ++k) {
    if (scene_.bodies[k].fixed) continue;
    const double gap = separation(robot, end[0], scene_.bodies[k].shape, end[k]);
    if (gap >= nearest || separation(robot, advanced, scene_.bodies[k].shape, end[k]) >= gap)
      continue;
    nearest = gap;
    best = k;
  }
  return best;
}

/// Returns whether a body other than `touched` lies on the robot's way back.
bool NaiveReverse::blocked(const Poses& end, std::size_t touched, const Vector2d& back) const {
  const double reach = scene_.bodies[0].shape.radius() + back.norm();
  for (std::size_t k = 1; k < scene_.size(); ++k) {
    if (k == touched) continue;
    const Shape& shape = scene_.bodies[k].shape;
    if ((end[k].position() - end[0].position()).norm() > reach + shape.radius()) continue;
    const int steps = static_cast<int>(back.norm() / kSweepStep) + 1;
    for (int step = 1; step <= steps; ++step) {
      const Pose robot = moved(end[0], static_cast<double>(step) / steps * back);
      if (separation(scene_.bodies[0].shape, robot, shape, end[k]) < 0.0) return true;
    }
  }
  return false;
}

ReverseResult NaiveReverse::solve(const ReverseJob& job) const {
  const Vector2d ahead = direction(job.action, push_);
  const std::size_t touched = touched_object(job.end, ahead);
  Poses start = job.end;
  const Vector2d back = -stride_of(job.action, push_) * ahead;
  start[0] = moved(job.end[0], back);
  if (!in_arena(start[0], push_) || blocked(job.end, touched, back)) return {SolveStatus::kPruned};
  std::vector<Poses> predecessors{start};
  if (touched != 0) predecessors = pulled(job, roots_[touched], start);
  std::erase_if(predecessors,
                [this](const Poses& s) { return first_overlap(scene_, s).has_value(); });
  if (predecessors.empty()) return {SolveStatus::kInfeasible};
  return {SolveStatus::kConverged, 0, std::move(predecessors)};
}

/// Returns one copy of `start` per draw of L, with `object` pulled back by L, along its axis if it
/// slides on a fixed body. Bodies that joints connect with `object` follow. Returns nothing if a
/// joint holds it to a fixed body otherwise.
std::vector<Poses> NaiveReverse::pulled(const ReverseJob& job, std::size_t object,
                                        const Poses& start) const {
  std::vector<Poses> out;
  const auto holds = [object](const Joint& joint) {
    return static_cast<std::size_t>(joint.child) == object && joint.type != JointType::kPrismatic;
  };
  if (std::ranges::any_of(scene_.joints, holds)) return out;
  const Vector2d ahead = direction(job.action, push_);
  Rng rng(key_of(job));
  for (int draw = 0; draw < kMaxPredecessors; ++draw) {
    const double pull = rng.uniform(kLeastPull, 1.0) * stride_of(job.action, push_);
    Poses one = start;
    one[object] = moved(job.end[object], -pull * ahead);
    out.push_back(with_closed_joints(scene_, std::move(one)));
  }
  return out;
}

}  // namespace rtg::reverse
