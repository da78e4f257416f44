#include "core/world/signed_distance.hpp"

namespace rtg {

HalfPlanes half_planes(const Polygon& shape) {
  HalfPlanes planes;
  planes.count = static_cast<int>(shape.size());
  for (std::size_t k = 0; k < shape.size(); ++k) {
    const Vector2d& v = shape.vertices[k];
    const Vector2d edge = shape.vertices[(k + 1) % shape.size()] - v;
    planes.normal[k] = Vector2d(edge.y(), -edge.x()).normalized();
    planes.offset[k] = planes.normal[k].dot(v);
  }
  return planes;
}

}  // namespace rtg
