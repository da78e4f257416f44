#pragma once

#include <nanobind/eigen/dense.h>

#include <vector>

#include "core/math/vectors.hpp"

namespace rtg::bindings {

/// Points of the plane as a numpy array. [N, 2] float64
using Vertices = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

inline Vertices vertices_of(const std::vector<Vector2d>& points) {
  Vertices out(static_cast<Eigen::Index>(points.size()), 2);
  for (Eigen::Index k = 0; k < out.rows(); ++k) out.row(k) = points[static_cast<std::size_t>(k)];
  return out;
}

}  // namespace rtg::bindings
