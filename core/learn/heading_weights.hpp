#pragma once

#include <Eigen/Core>
#include <type_traits>

namespace rtg::learn {

/// Sizes of a HeadingNetwork.
struct NetworkSizes {
  int inputs = 0;
  int headings = 0;
  int hidden = 0;    // units of each of the two layers of the trunk
  int features = 0;  // of each of w, u and v
};

/// Returns the number of weights of a network of these sizes.
inline int weight_count(const NetworkSizes& s) {
  const auto linear = [](int outputs, int inputs) { return outputs * (inputs + 1); };
  return linear(s.hidden, s.inputs) + linear(s.hidden, s.hidden) + 4 * s.hidden +
         linear(3 * s.features + 1, s.hidden) + linear(s.features, s.features) + 2 * s.features +
         linear(1, s.features);
}

template <class Real>  // float, or const float for weights that do not change
using MatrixOf = Eigen::Map<
    std::conditional_t<std::is_const_v<Real>, const Eigen::Matrix<float, -1, -1, Eigen::RowMajor>,
                       Eigen::Matrix<float, -1, -1, Eigen::RowMajor>>>;
template <class Real>
using VectorOf =
    Eigen::Map<std::conditional_t<std::is_const_v<Real>, const Eigen::VectorXf, Eigen::VectorXf>>;

/// y = W x + b
template <class Real>
struct Linear {
  MatrixOf<Real> weight;  // W [outputs, inputs]
  VectorOf<Real> bias;    // b [outputs]
};

/// y = γ x̂ + β, where x̂ is x with mean 0 and variance 1
template <class Real>
struct Norm {
  VectorOf<Real> scale;  // γ
  VectorOf<Real> shift;  // β
};

/// The weights of a HeadingNetwork, or the gradient for them: views of one array. They lie in it in
/// the order of this list, each matrix by rows, as in PyTorch.
template <class Real>
class HeadingWeights {
  Real* next_;  // the first number that no view has yet

  VectorOf<Real> vector(int size) { return {take(size), size}; }
  Linear<Real> linear(int outputs, int inputs) {
    Real* const weight = take(outputs * inputs);
    return {{weight, outputs, inputs}, vector(outputs)};
  }
  Norm<Real> norm(int size) {
    Real* const scale = take(size);
    return {{scale, size}, vector(size)};
  }
  Real* take(int count) {
    next_ += count;
    return next_ - count;
  }

 public:
  Linear<Real> first;
  Norm<Real> first_norm;
  Linear<Real> second;
  Norm<Real> second_norm;
  Linear<Real> features, value;
  Norm<Real> along_norm;
  Linear<Real> along, advantage;

  HeadingWeights(const NetworkSizes& s, Real* array)
      : next_(array),
        first(linear(s.hidden, s.inputs)),
        first_norm(norm(s.hidden)),
        second(linear(s.hidden, s.hidden)),
        second_norm(norm(s.hidden)),
        features(linear(3 * s.features, s.hidden)),
        value(linear(1, s.hidden)),
        along_norm(norm(s.features)),
        along(linear(s.features, s.features)),
        advantage(linear(1, s.features)) {}
};

}  // namespace rtg::learn
