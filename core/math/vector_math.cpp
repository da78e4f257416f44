#include "core/math/vector_math.hpp"

#include <cmath>

namespace rtg::vector_math {

void exponentials(double* x, int count) {
  for (int k = 0; k < count; ++k) x[k] = std::exp(x[k]);
}
void sines(double* x, int count) {
  for (int k = 0; k < count; ++k) x[k] = std::sin(x[k]);
}
void cosines(double* x, int count) {
  for (int k = 0; k < count; ++k) x[k] = std::cos(x[k]);
}
void hyperbolic_tangents(double* x, int count) {
  for (int k = 0; k < count; ++k) x[k] = std::tanh(x[k]);
}
void logarithms(double* x, int count) {
  for (int k = 0; k < count; ++k) x[k] = std::log(x[k]);
}

}  // namespace rtg::vector_math
