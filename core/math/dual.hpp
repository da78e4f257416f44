#pragma once

#include <Eigen/Core>
#include <cmath>

namespace rtg {

/// Dual number v + d·ε with ε² = 0: evaluating a derivative formula at q + ε y adds the derivative
/// of its result along y. Applied to gradients and Hessians it gives y·∇(...), the contractions
/// that the Hessian of a Lagrangian is made of.
struct Dual {
  double v = 0.0;  // value
  double d = 0.0;  // derivative along the direction

  constexpr Dual() = default;
  constexpr Dual(double value) : v(value) {}  // NOLINT: a constant is a dual number
  constexpr Dual(double value, double derivative) : v(value), d(derivative) {}

  Dual& operator+=(const Dual& b) { return *this = Dual(v + b.v, d + b.d); }
  Dual& operator-=(const Dual& b) { return *this = Dual(v - b.v, d - b.d); }
  Dual& operator*=(const Dual& b) { return *this = Dual(v * b.v, d * b.v + v * b.d); }
  Dual& operator/=(const Dual& b) {
    const double q = v / b.v;
    return *this = Dual(q, (d - q * b.d) / b.v);
  }

  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator*(Dual a, const Dual& b) { return a *= b; }
  friend Dual operator/(Dual a, const Dual& b) { return a /= b; }
  friend Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
};

inline Dual exp(const Dual& x) {
  const double e = std::exp(x.v);
  return {e, e * x.d};
}
inline Dual log(const Dual& x) { return {std::log(x.v), x.d / x.v}; }
inline Dual sin(const Dual& x) { return {std::sin(x.v), std::cos(x.v) * x.d}; }
inline Dual cos(const Dual& x) { return {std::cos(x.v), -std::sin(x.v) * x.d}; }
inline Dual sqrt(const Dual& x) {
  const double r = std::sqrt(x.v);
  return {r, x.d / (2.0 * r)};
}

/// The plain number in a scalar.
inline double value_of(double x) { return x; }
inline double value_of(const Dual& x) { return x.v; }

}  // namespace rtg

template <>
struct Eigen::NumTraits<rtg::Dual> : Eigen::NumTraits<double> {
  using Real = rtg::Dual;
  using NonInteger = rtg::Dual;
  using Nested = rtg::Dual;
  enum { IsComplex = 0, RequireInitialization = 1, ReadCost = 2, AddCost = 2, MulCost = 4 };
};
