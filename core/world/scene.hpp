#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/world/polygon.hpp"
#include "core/world/pose.hpp"

namespace rtg {

/// A rigid body. Its frame sits at the centroid of `shape`.
struct Body {
  std::string name;
  std::string kind;       // class label that goals refer to, for example "box"
  Polygon shape;          // centred() [m]
  double density = 1.0;   // ρ [kg/m²]
  double friction = 0.3;  // μ_f; a pair uses √(μ₁μ₂), as Box2D does
  bool fixed = false;     // takes part in contact, has no coordinates (a wall)

  bool operator==(const Body&) const = default;
};

/// Revolute joint: a point of the child is pinned to one of the parent. The two do not collide.
/// lower ≤ upper.
struct Joint {
  int parent = 0, child = 0;                                // bodies of the scene
  Vector2d on_parent = Vector2d::Zero();                    // the pin in the parent's frame [m]
  Vector2d on_child = Vector2d::Zero();                     // the pin in the child's frame [m]
  double lower = -std::numeric_limits<double>::infinity();  // limits of θ_child - θ_parent [rad]
  double upper = std::numeric_limits<double>::infinity();

  bool operator==(const Joint&) const = default;
};

/// The bodies of a task; bodies[0] is the robot, which has no joint. Joints make trees of the
/// others: no body is the child of two, no child is fixed.
struct Scene {
  std::vector<Body> bodies;
  std::vector<Joint> joints = {};

  std::size_t size() const { return bodies.size(); }
};

/// Says whether the body has a joint.
bool has_joint(const Scene& scene, std::size_t body);

/// Says whether a joint connects the two bodies.
bool jointed(const Scene& scene, std::size_t a, std::size_t b);

/// Distance between the two points that a joint pins together [m].
double joint_gap(const Joint& joint, const Poses& poses);

/// θ_child - θ_parent [rad].
double joint_angle(const Joint& joint, const Poses& poses);

/// Indices of joints, those of parents before those of their children.
std::vector<std::size_t> root_first(const Scene& scene);

/// Per body the one at the root of the tree of joints that it belongs to; itself without a joint.
std::vector<std::size_t> roots_of(const Scene& scene);

/// Per body the one that stands for all that move with it: as roots_of(), but what hangs on a fixed
/// body moves alone.
std::vector<std::size_t> movers_of(const Scene& scene);

/// `poses` with every child moved, its angle kept, to where its pin closes.
Poses with_closed_joints(const Scene& scene, Poses poses);

/// m and J (about the centroid) of a body [kg], [kg·m²].
struct Mass {
  double mass = 0.0, moment = 0.0;
};
Mass mass_of(const Body& body);

/// μ_f of a pair.
double pair_friction(const Body& a, const Body& b);

}  // namespace rtg
