#include "core/search/state_metric.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/hash.hpp"

namespace rtg::search {
namespace {

constexpr double kRobotCell = 0.8;   // side of a cell [m]
constexpr double kObjectCell = 0.4;  // side of a cell [m], [rad]
constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kAngleRadius = 0.5;  // r [m], about the radius of gyration of a 1.2 m box

std::int64_t slot(double x, double side) { return static_cast<std::int64_t>(std::floor(x / side)); }

std::uint64_t with_slot(std::uint64_t hash, std::int64_t number) {
  return hashed(hash, static_cast<std::uint64_t>(number));
}

}  // namespace

StateMetric::StateMetric(const Scene& scene) {
  for (std::size_t k = 1; k < scene.size(); ++k) {
    const bool jointed = has_joint(scene, k);
    if (!scene.bodies[k].fixed)
      objects_.push_back({k, jointed, jointed ? kTwoPi : scene.bodies[k].shape.symmetry()});
  }
}

double StateMetric::distance(const Object& o, const Poses& a, const Poses& b) const {
  const double way = (a[o.body].position() - b[o.body].position()).norm();
  if (o.turn == 0.0) return way;
  return way + kAngleRadius * std::abs(std::remainder(a[o.body].theta - b[o.body].theta, o.turn));
}

double StateMetric::layout_distance(const Poses& a, const Poses& b) const {
  double sum = 0.0;
  for (const Object& o : objects_) sum += distance(o, a, b);
  return sum;
}

std::uint64_t StateMetric::layout_cell(const Poses& poses) const {
  std::uint64_t hash = 0;
  for (const Object& o : objects_) {
    const Pose& p = poses[o.body];
    const auto slots = std::max<std::int64_t>(1, std::llround(o.turn / kObjectCell));
    const double side = o.turn / static_cast<double>(slots);
    const std::int64_t turn = side > 0.0 ? slot(p.theta, side) : 0;
    hash = with_slot(hash, slot(p.x, kObjectCell));
    hash = with_slot(hash, slot(p.y, kObjectCell));
    hash = with_slot(hash, ((turn % slots) + slots) % slots);
  }
  return hash;
}

std::uint64_t StateMetric::cell(const Poses& poses) const {
  const std::uint64_t hash = with_slot(layout_cell(poses), slot(poses[0].x, kRobotCell));
  return with_slot(hash, slot(poses[0].y, kRobotCell));
}

}  // namespace rtg::search
