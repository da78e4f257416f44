#pragma once

#include <string>
#include <vector>

#include "core/world/polygon.hpp"

namespace rtg {

/// One rigid body. Its frame sits at the centroid of `shape`.
struct Body {
  std::string name;
  std::string kind;       // class label that goals refer to, for example "box"
  Polygon shape;          // centred() [m]
  double density = 1.0;   // ρ [kg/m²]
  double friction = 0.3;  // μ_f; a pair uses √(μ₁μ₂), as Box2D does
  bool fixed = false;     // takes part in contact, has no coordinates (a wall)

  bool operator==(const Body&) const = default;
};

/// The bodies of a task; bodies[0] is the robot.
struct Scene {
  std::vector<Body> bodies;

  std::size_t size() const { return bodies.size(); }
};

/// m and J (about the centroid) of a body [kg], [kg·m²].
struct Mass {
  double mass = 0.0, moment = 0.0;
};
Mass mass_of(const Body& body);

/// μ_f of a pair.
double pair_friction(const Body& a, const Body& b);

}  // namespace rtg
