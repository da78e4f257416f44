#include "core/math/elementary.hpp"

#include <cassert>

#include "core/math/vector_math.hpp"

namespace rtg {
namespace {

constexpr int kWide = kWidth<Lanes>;

/// Calls f on an array of all doubles in x[0], ..., x[count - 1]. f replaces them in place.
template <class F>
void as_numbers(Lanes* x, int count, F&& f) {
  assert(count <= kMaxExponentials);
  double buffer[kMaxExponentials * kWide];
  for (int k = 0; k < count; ++k)
    x[k].copy_to(buffer + k * kWide, std::experimental::element_aligned);
  f(buffer, count * kWide);
  for (int k = 0; k < count; ++k)
    x[k].copy_from(buffer + k * kWide, std::experimental::element_aligned);
}

}  // namespace

void exponentials(double* x, int count) {
  for (int k = 0; k < count; ++k) x[k] = std::exp(x[k]);
}
void exponentials(Lanes* x, int count) { as_numbers(x, count, vector_math::exponentials); }

Turn<double> turn_of(double angle) { return {std::cos(angle), std::sin(angle)}; }
Turn<Lanes> turn_of(const Lanes& angle) {
  Turn<Lanes> out{angle, angle};
  as_numbers(&out.c, 1, vector_math::cosines);
  as_numbers(&out.s, 1, vector_math::sines);
  return out;
}

double hyperbolic_tangent(double x) { return std::tanh(x); }
Lanes hyperbolic_tangent(const Lanes& x) {
  Lanes out = x;
  as_numbers(&out, 1, vector_math::hyperbolic_tangents);
  return out;
}
double logarithm(double x) { return std::log(x); }
Lanes logarithm(const Lanes& x) {
  Lanes out = x;
  as_numbers(&out, 1, vector_math::logarithms);
  return out;
}

}  // namespace rtg
