#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/world/pose.hpp"
#include "core/world/shape.hpp"

namespace rtg {

/// A rigid body. Its frame sits at the centroid of `shape`.
struct Body {
  std::string name;
  std::string kind;       // class label that goals refer to, for example "box"
  Shape shape;            // centred() [m]
  double density = 1.0;   // ρ [kg/m²]
  double friction = 0.3;  // μ_f; a pair uses √(μ₁μ₂), as Box2D does
  bool fixed = false;     // takes part in contact, has no coordinates (a wall)

  bool operator==(const Body&) const = default;
};

/// Revolute joint: a point of the child is pinned to a point of the parent. The two bodies do not
/// collide with each other. lower ≤ upper.
struct Joint {
  int parent = 0, child = 0;                                // bodies of the scene
  Vector2d on_parent = Vector2d::Zero();                    // the pin in the parent's frame [m]
  Vector2d on_child = Vector2d::Zero();                     // the pin in the child's frame [m]
  double lower = -std::numeric_limits<double>::infinity();  // limits of θ_child - θ_parent [rad]
  double upper = std::numeric_limits<double>::infinity();

  bool operator==(const Joint&) const = default;
};

/// The bodies of a task and their joints. bodies[0] is the robot, which has no joint. The joints
/// connect the other bodies to trees. Hence no body is the child of two joints. No child is fixed.
struct Scene {
  std::vector<Body> bodies;
  std::vector<Joint> joints = {};

  std::size_t size() const { return bodies.size(); }
};

/// Returns whether the body has a joint, as parent or as child.
bool has_joint(const Scene& scene, std::size_t body);

/// Returns whether a joint connects the two bodies.
bool jointed(const Scene& scene, std::size_t a, std::size_t b);

/// Returns the distance between the two points that a joint pins together [m].
double joint_gap(const Joint& joint, const Poses& poses);

/// Returns θ_child - θ_parent [rad].
double joint_angle(const Joint& joint, const Poses& poses);

/// Returns the indices of all joints, in an order from the roots of the trees to the leaves.
std::vector<std::size_t> root_first(const Scene& scene);

/// Returns for each body the root of its tree of joints. A body without joints is its own root.
std::vector<std::size_t> roots_of(const Scene& scene);

/// Returns for each body its root as in roots_of(), except that a child of a fixed body counts as a
/// root. Bodies with the same result move together.
std::vector<std::size_t> moving_group_roots(const Scene& scene);

/// Returns `poses` with all joints closed. Each child is translated until its pin meets that of the
/// parent; angles stay.
Poses with_closed_joints(const Scene& scene, Poses poses);

/// Mass m [kg] and moment of inertia J about the centroid [kg·m²] of a body.
struct Mass {
  double mass = 0.0, moment = 0.0;
};
Mass mass_of(const Body& body);

/// Returns the friction coefficient μ_f of a pair of bodies.
double pair_friction(const Body& a, const Body& b);

}  // namespace rtg
