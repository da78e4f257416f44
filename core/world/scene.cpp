#include "core/world/scene.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace rtg {

Mass mass_of(const Body& body) {
  const Moments& m = body.shape.moments();
  return {body.density * m.area, body.density * m.polar};
}

double pair_friction(const Body& a, const Body& b) { return std::sqrt(a.friction * b.friction); }

bool has_joint(const Scene& scene, std::size_t body) {
  return std::ranges::any_of(scene.joints, [body](const Joint& joint) {
    return static_cast<std::size_t>(joint.parent) == body ||
           static_cast<std::size_t>(joint.child) == body;
  });
}

bool jointed(const Scene& scene, std::size_t a, std::size_t b) {
  return std::ranges::any_of(scene.joints, [a, b](const Joint& joint) {
    const auto i = static_cast<std::size_t>(joint.parent),
               j = static_cast<std::size_t>(joint.child);
    return (i == a && j == b) || (i == b && j == a);
  });
}

double joint_value(const Joint& joint, const Poses& poses) {
  const Pose& parent = poses[static_cast<std::size_t>(joint.parent)];
  const Pose& child = poses[static_cast<std::size_t>(joint.child)];
  if (joint.type == JointType::kRevolute) return child.theta - parent.theta;
  if (joint.type == JointType::kFixed) return 0.0;
  const Vector2d apart = to_world(child, joint.on_child) - to_world(parent, joint.on_parent);
  return apart.dot(rotate(parent.theta, joint.axis));
}

Pose closed_child(const Joint& joint, const Poses& poses) {
  const Pose& parent = poses[static_cast<std::size_t>(joint.parent)];
  Pose child = poses[static_cast<std::size_t>(joint.child)];
  if (joint.type != JointType::kRevolute) child.theta = parent.theta + joint.angle;
  Vector2d pin = to_world(parent, joint.on_parent);
  if (joint.type == JointType::kPrismatic) {
    const Vector2d axis = rotate(parent.theta, joint.axis);
    pin += axis.dot(to_world(child, joint.on_child) - pin) * axis;
  }
  const Vector2d at = pin - rotate(child.theta, joint.on_child);
  return {at.x(), at.y(), child.theta};
}

void set_joint_value(const Joint& joint, double value, Poses& poses) {
  const double turn = poses[static_cast<std::size_t>(joint.parent)].theta;
  Pose& child = poses[static_cast<std::size_t>(joint.child)];
  if (joint.type == JointType::kRevolute) child.theta = turn + value;
  child = closed_child(joint, poses);
  if (joint.type != JointType::kPrismatic) return;
  const Vector2d by = (value - joint_value(joint, poses)) * rotate(turn, joint.axis);
  child.x += by.x();
  child.y += by.y();
}

double joint_gap(const Joint& joint, const Poses& poses) {
  const Pose& child = poses[static_cast<std::size_t>(joint.child)];
  return (closed_child(joint, poses).position() - child.position()).norm();
}

std::vector<std::size_t> root_first(const Scene& scene) {
  std::vector<std::size_t> order;
  std::vector<int> waiting(scene.size(), 0);  // per child: joints not listed yet
  for (const Joint& joint : scene.joints) {
    assert(joint.parent > 0 && joint.child > 0 && joint.lower <= joint.upper);
    ++waiting[static_cast<std::size_t>(joint.child)];
  }
  for (bool found = true; found && order.size() < scene.joints.size();) {
    found = false;
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      const Joint& joint = scene.joints[k];
      if (waiting[static_cast<std::size_t>(joint.parent)] > 0 ||
          waiting[static_cast<std::size_t>(joint.child)] == 0)
        continue;
      waiting[static_cast<std::size_t>(joint.child)] = 0;
      order.push_back(k);
      found = true;
    }
  }
  assert(order.size() == scene.joints.size());
  return order;
}

namespace {

/// Returns for each body its farthest ancestor along binding joints; the body itself if it has
/// none. A joint is binding if binds(parent) is true.
template <class Binds>
std::vector<std::size_t> first_of(const Scene& scene, Binds binds) {
  std::vector<std::size_t> first(scene.size());
  std::iota(first.begin(), first.end(), std::size_t{0});
  for (const std::size_t k : root_first(scene)) {
    const auto parent = static_cast<std::size_t>(scene.joints[k].parent);
    if (binds(parent)) first[static_cast<std::size_t>(scene.joints[k].child)] = first[parent];
  }
  return first;
}

}  // namespace

std::vector<std::size_t> roots_of(const Scene& scene) {
  return first_of(scene, [](std::size_t) { return true; });
}

std::vector<std::size_t> moving_group_roots(const Scene& scene) {
  return first_of(scene, [&](std::size_t parent) { return !scene.bodies[parent].fixed; });
}

Poses with_closed_joints(const Scene& scene, Poses poses) {
  for (const std::size_t k : root_first(scene)) {
    const Joint& joint = scene.joints[k];
    poses[static_cast<std::size_t>(joint.child)] = closed_child(joint, poses);
  }
  return poses;
}

}  // namespace rtg
