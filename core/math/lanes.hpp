#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <experimental/simd>

namespace rtg {

/// A SIMD vector of doubles. Each lane holds the same quantity of another candidate, an independent
/// problem that is solved at the same time.
///
/// Templates over a scalar T are compiled for double (one candidate) and for Lanes. No operation
/// mixes lanes, so the results of a candidate do not depend on those in the other lanes.
using Lanes = std::experimental::native_simd<double>;

/// Mask<T> is one truth value per lane: bool for double.
template <class T>
struct MaskOf {
  using type = bool;
};
template <>
struct MaskOf<Lanes> {
  using type = Lanes::mask_type;
};
template <class T>
using Mask = typename MaskOf<T>::type;

template <class T>
inline constexpr int kWidth = 1;
template <>
inline constexpr int kWidth<Lanes> = static_cast<int>(Lanes::size());

inline double select(bool mask, double yes, double no) { return mask ? yes : no; }
inline Lanes select(const Lanes::mask_type& mask, const Lanes& yes, const Lanes& no) {
  Lanes out = no;
  where(mask, out) = yes;
  return out;
}

inline bool any(bool mask) { return mask; }
inline bool any(const Lanes::mask_type& mask) { return any_of(mask); }

inline double greater(double a, double b) { return a > b ? a : b; }
inline double lesser(double a, double b) { return a < b ? a : b; }
inline Lanes greater(const Lanes& a, const Lanes& b) { return select(a > b, a, b); }
inline Lanes lesser(const Lanes& a, const Lanes& b) { return select(a < b, a, b); }

inline double magnitude(double x) { return std::abs(x); }
inline Lanes magnitude(const Lanes& x) { return std::experimental::abs(x); }

#if defined(__AVX512F__)
using Register = __m512d;  // the processor's type for Lanes
#elif defined(__AVX2__) && defined(__FMA__)
using Register = __m256d;
#elif defined(__x86_64__)
#error "RTG_PROCESSOR is below x86-64-v3"
#endif

/// Return z ± x y, rounded once. The compiler fuses no product by itself (-ffp-contract=off), as
/// its choice depends on the processor.
inline double plus_product(double z, double x, double y) { return std::fma(x, y, z); }
inline double minus_product(double z, double x, double y) { return std::fma(-x, y, z); }
inline Lanes plus_product(const Lanes& z, const Lanes& x, const Lanes& y) {
#if defined(__AVX512F__)
  return Lanes(_mm512_fmadd_pd(Register(x), Register(y), Register(z)));
#elif defined(__FMA__)
  return Lanes(_mm256_fmadd_pd(Register(x), Register(y), Register(z)));
#else
  return Lanes([&](auto l) { return std::fma(x[l], y[l], z[l]); });
#endif
}
inline Lanes minus_product(const Lanes& z, const Lanes& x, const Lanes& y) {
#if defined(__AVX512F__)
  return Lanes(_mm512_fnmadd_pd(Register(x), Register(y), Register(z)));
#elif defined(__FMA__)
  return Lanes(_mm256_fnmadd_pd(Register(x), Register(y), Register(z)));
#else
  return plus_product(z, -x, y);
#endif
}

inline double root(double x) { return std::sqrt(x); }
inline Lanes root(const Lanes& x) { return std::experimental::sqrt(x); }

/// lane() returns the value in lane `l` of x; set_lane() sets it. A double or bool has a single
/// lane.
inline double lane(double x, int) { return x; }
inline double lane(const Lanes& x, int l) { return x[static_cast<std::size_t>(l)]; }
inline bool lane(bool x, int) { return x; }
inline bool lane(const Lanes::mask_type& x, int l) { return x[static_cast<std::size_t>(l)]; }
inline void set_lane(double& x, int, double value) { x = value; }
inline void set_lane(Lanes& x, int l, double value) { x[static_cast<std::size_t>(l)] = value; }
inline void set_lane(bool& x, int, bool value) { x = value; }
inline void set_lane(Lanes::mask_type& x, int l, bool value) {
  x[static_cast<std::size_t>(l)] = value;
}

}  // namespace rtg

template <>
struct Eigen::NumTraits<rtg::Lanes> : Eigen::NumTraits<double> {
  using Real = rtg::Lanes;
  using NonInteger = rtg::Lanes;
  using Nested = rtg::Lanes;
  enum { IsComplex = 0, RequireInitialization = 1, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
