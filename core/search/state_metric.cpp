#include "core/search/state_metric.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/hash.hpp"

namespace rtg {
namespace {

constexpr double kObjectWeight = 1.5;  // w
constexpr double kAngleRadius = 0.5;   // r [m], about the radius of gyration of a 1.2 m box

bool maps_onto_itself(const Polygon& shape, std::size_t shift, double tolerance) {
  const double angle =
      2.0 * std::numbers::pi * static_cast<double>(shift) / static_cast<double>(shape.size());
  for (std::size_t k = 0; k < shape.size(); ++k) {
    const Vector2d turned = rotate(angle, shape.vertices[k]);
    if ((turned - shape.vertices[(k + shift) % shape.size()]).norm() > tolerance) return false;
  }
  return true;
}

std::int64_t slot(double x, double side, double shift) {
  return static_cast<std::int64_t>(std::floor(x / side + shift));
}

std::uint64_t with_slot(std::uint64_t hash, std::int64_t number) {
  return hashed(hash, static_cast<std::uint64_t>(number));
}

}  // namespace

int symmetry_order(const Polygon& shape) {
  const double tolerance = 1e-6 * bounding_radius(shape);
  const std::size_t n = shape.size();
  for (std::size_t shift = 1; shift < n; ++shift)
    if (n % shift == 0 && maps_onto_itself(shape, shift, tolerance))
      return static_cast<int>(n / shift);
  return 1;
}

double angle_difference(double a, double b, int order) {
  const double period = 2.0 * std::numbers::pi / order;
  return std::remainder(a - b, period);
}

StateMetric::StateMetric(const Scene& scene) {
  for (std::size_t k = 1; k < scene.size(); ++k)
    if (!scene.bodies[k].fixed)
      objects_.push_back({k, has_joint(scene, k) ? 1 : symmetry_order(scene.bodies[k].shape)});
}

void StateMetric::embed(const Poses& poses, std::span<float> out) const {
  out[0] = static_cast<float>(poses[0].x);
  out[1] = static_cast<float>(poses[0].y);
  std::size_t at = 2;
  for (const Object& o : objects_) {
    const Pose& p = poses[o.body];
    const double radius = kObjectWeight * kAngleRadius / o.order;
    out[at++] = static_cast<float>(kObjectWeight * p.x);
    out[at++] = static_cast<float>(kObjectWeight * p.y);
    out[at++] = static_cast<float>(radius * std::cos(o.order * p.theta));
    out[at++] = static_cast<float>(radius * std::sin(o.order * p.theta));
  }
}

double StateMetric::distance(const Poses& a, const Poses& b) const {
  std::vector<float> u(static_cast<std::size_t>(size())), v(u.size());
  embed(a, u);
  embed(b, v);
  double sum = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) sum += (u[k] - v[k]) * (u[k] - v[k]);
  return std::sqrt(sum);
}

double StateMetric::layout_distance(const Poses& a, const Poses& b) const {
  double sum = 0.0;
  for (const Object& o : objects_)
    sum += (a[o.body].position() - b[o.body].position()).norm() +
           kAngleRadius * std::abs(angle_difference(a[o.body].theta, b[o.body].theta, o.order));
  return sum;
}

StateMetric::Spread StateMetric::spread(const Poses& a, const Poses& b) const {
  Spread out;
  for (const Object& o : objects_) {
    const Vector2d d = a[o.body].position() - b[o.body].position();
    out.position = std::max(out.position, d.cwiseAbs().maxCoeff());
    out.angle =
        std::max(out.angle, std::abs(angle_difference(a[o.body].theta, b[o.body].theta, o.order)));
  }
  return out;
}

bool StateMetric::within(const Poses& a, const Poses& b, double tolerance) const {
  const auto beside = [&](std::size_t k) {
    return std::abs(a[k].x - b[k].x) <= tolerance && std::abs(a[k].y - b[k].y) <= tolerance;
  };
  return beside(0) && std::ranges::all_of(objects_, [&](const Object& o) {
           return beside(o.body) && std::abs(angle_difference(a[o.body].theta, b[o.body].theta,
                                                              o.order)) <= tolerance;
         });
}

std::uint64_t StateMetric::cell(const Poses& poses, const Cells& cells) const {
  std::uint64_t hash = with_slot(0, slot(poses[0].x, cells.robot, cells.shift));
  hash = with_slot(hash, slot(poses[0].y, cells.robot, cells.shift));
  for (const Object& o : objects_) {
    const Pose& p = poses[o.body];
    const double period = 2.0 * std::numbers::pi / o.order;
    const auto slots = std::max<std::int64_t>(1, std::llround(period / cells.object));
    const std::int64_t turn = slot(p.theta, period / static_cast<double>(slots), cells.shift);
    hash = with_slot(hash, slot(p.x, cells.object, cells.shift));
    hash = with_slot(hash, slot(p.y, cells.object, cells.shift));
    hash = with_slot(hash, ((turn % slots) + slots) % slots);
  }
  return hash;
}

}  // namespace rtg
