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

double joint_gap(const Joint& joint, const Poses& poses) {
  return (to_world(poses[static_cast<std::size_t>(joint.parent)], joint.on_parent) -
          to_world(poses[static_cast<std::size_t>(joint.child)], joint.on_child))
      .norm();
}

double joint_angle(const Joint& joint, const Poses& poses) {
  return poses[static_cast<std::size_t>(joint.child)].theta -
         poses[static_cast<std::size_t>(joint.parent)].theta;
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
    const Vector2d pin = to_world(poses[static_cast<std::size_t>(joint.parent)], joint.on_parent);
    Pose& child = poses[static_cast<std::size_t>(joint.child)];
    const Vector2d at = pin - rotate(child.theta, joint.on_child);
    child.x = at.x();
    child.y = at.y();
  }
  return poses;
}

}  // namespace rtg
