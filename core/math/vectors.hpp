#pragma once

#include <Eigen/Core>

namespace rtg {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Vectors and matrices of fixed size over a scalar T: double, or Lanes.

template <class T>
using Vec2 = Eigen::Matrix<T, 2, 1>;
template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Vec4 = Eigen::Matrix<T, 4, 1>;
template <class T>
using Mat2 = Eigen::Matrix<T, 2, 2>;
template <class T>
using Mat4 = Eigen::Matrix<T, 4, 4>;

}  // namespace rtg
