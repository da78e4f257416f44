#include "core/world/signed_distance.hpp"

namespace rtg {

HalfPlanes half_planes(const Polygon& shape) {
  HalfPlanes planes;
  planes.count = static_cast<int>(shape.size());
  if (shape.size() == 1) {
    planes.normal[0] = planes.edge[0] = Vector2d::Zero();
    planes.corner[0] = shape.vertices[0];
    return planes;
  }
  for (std::size_t k = 0; k < shape.size(); ++k) {
    const Vector2d& v = shape.vertices[k];
    const Vector2d edge = shape.vertices[(k + 1) % shape.size()] - v;
    planes.normal[k] = edge_normal(shape, k);
    planes.offset[k] = planes.normal[k].dot(v);
    planes.corner[k] = v;
    planes.edge[k] = edge;
    planes.inverse_square[k] = 1.0 / edge.squaredNorm();
  }
  return planes;
}

}  // namespace rtg
