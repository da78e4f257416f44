#include "core/world/scene.hpp"

#include <cmath>

namespace rtg {

Mass mass_of(const Body& body) {
  const Moments m = moments(body.shape);
  return {body.density * m.area, body.density * m.polar};
}

double pair_friction(const Body& a, const Body& b) { return std::sqrt(a.friction * b.friction); }

}  // namespace rtg
