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

enum class JointType {
  kRevolute,   // the child turns about a pin
  kPrismatic,  // the child slides along an axis
  kFixed,      // the child stays where it is on its parent
};

/// A joint of a parent i and a child j. With their positions t and rotations R, a point a of the
/// parent, a point b of the child, an axis u of the parent and an angle α it holds
///
///   revolute:   t_j + R_j b = t_i + R_i a,           its value is φ = θ_j - θ_i [rad];
///   prismatic:  t_j + R_j b = t_i + R_i (a + s u),   θ_j = θ_i + α, its value is s [m];
///   fixed:      t_j + R_j b = t_i + R_i a,           θ_j = θ_i + α, without a value.
///
/// The two bodies do not collide with each other. lower ≤ upper.
struct Joint {
  int parent = 0, child = 0;                                // i, j
  Vector2d on_parent = Vector2d::Zero();                    // a [m]
  Vector2d on_child = Vector2d::Zero();                     // b [m]
  double lower = -std::numeric_limits<double>::infinity();  // limits of the value
  double upper = std::numeric_limits<double>::infinity();
  JointType type = JointType::kRevolute;
  Vector2d axis = Vector2d::UnitX();  // u, of a prismatic joint
  double angle = 0.0;                 // α [rad], of all but revolute joints

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

/// Returns the value of a joint: φ [rad] or s [m]; 0 if it has none.
double joint_value(const Joint& joint, const Poses& poses);

/// Moves the child to where the joint is closed and has this value; a fixed joint ignores it.
void set_joint_value(const Joint& joint, double value, Poses& poses);

/// Returns the pose of the child nearest to its own at which the joint is closed.
Pose closed_child(const Joint& joint, const Poses& poses);

/// Returns the distance of the child from closed_child() [m].
double joint_gap(const Joint& joint, const Poses& poses);

/// Returns the indices of all joints, in an order from the roots of the trees to the leaves.
std::vector<std::size_t> root_first(const Scene& scene);

/// Returns for each body the root of its tree of joints. A body without joints is its own root.
std::vector<std::size_t> roots_of(const Scene& scene);

/// Returns for each body its root as in roots_of(), except that a child of a fixed body counts as a
/// root. Bodies with the same result move together.
std::vector<std::size_t> moving_group_roots(const Scene& scene);

/// Returns `poses` with all joints closed, from the roots to the leaves: each child at its
/// closed_child().
Poses with_closed_joints(const Scene& scene, Poses poses);

/// Mass m [kg] and moment of inertia J about the centroid [kg·m²] of a body.
struct Mass {
  double mass = 0.0, moment = 0.0;
};
Mass mass_of(const Body& body);

/// Returns the friction coefficient μ_f of a pair of bodies.
double pair_friction(const Body& a, const Body& b);

}  // namespace rtg
