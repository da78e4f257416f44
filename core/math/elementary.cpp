#include "core/math/elementary_lanes.hpp"

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numbers>

namespace rtg {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeast = std::numeric_limits<double>::min();

/// The bits of a number, one word per lane.
template <class T>
struct WordsOf {
  using type = std::uint64_t;
};
template <>
struct WordsOf<Lanes> {
  using type = std::experimental::rebind_simd_t<std::uint64_t, Lanes>;
};
template <class T>
using Words = typename WordsOf<T>::type;

template <class T>
Words<T> words(const T& x) {
  return std::bit_cast<Words<T>>(x);
}
template <class T>
T number(const Words<T>& bits) {
  return std::bit_cast<T>(bits);
}

constexpr int kMantissaBits = 52;
constexpr std::uint64_t kBias = 1023;  // of the exponent
constexpr std::uint64_t kSign = std::uint64_t{1} << 63;

// x + kShift ends in the bits of the integer next to x; |x| ≤ 2^50.
constexpr double kShift = 0x1.8p52;

/// Returns c_0 + c_1 x + c_2 x² ... by Horner's rule.
template <class T>
T polynomial(const T& x, std::initializer_list<double> c) {
  const double* at = c.end();
  T sum(*--at);
  while (at != c.begin()) sum = plus_product(T(*--at), sum, x);
  return sum;
}

/// e^x = scale (1 + rest), where scale is a power of two and |rest| ≤ 0.42.
template <class T>
struct Exponential {
  T scale, rest;

  explicit Exponential(const T& x) {
    const T shifted = plus_product(T(kShift), x, T(std::numbers::log2e));
    const T k = shifted - T(kShift);
    const T r = minus_product(minus_product(x, k, T(0x1.62e42fefa39efp-1)), k,
                              T(0x1.abc9e3b39803fp-56));  // ln 2 in two parts
    // The series of (e^r - 1 - r)/r², for |r| ≤ ln 2 / 2.
    const T tail = polynomial(
        r, {1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880,
            1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800});
    rest = plus_product(r, r * r, tail);
    scale = number<T>((words(shifted) + Words<T>(kBias)) << kMantissaBits);
  }
};

template <class T>
T exponential_of(const T& x) {
  const Exponential<T> e(x);
  const T out = plus_product(e.scale, e.scale, e.rest);
  return select(x < T(-708.0), T(0.0), select(x > T(708.0), T(kInfinity), out));
}

/// From e^2|x| - 1, which is exact to a few bits for small x.
template <class T>
T hyperbolic_tangent_of(const T& x) {
  const T size = magnitude(x);
  const Exponential<T> e(T(2.0) * select(size > T(22.0), T(22.0), size));
  const T less_one = plus_product(e.scale - T(1.0), e.scale, e.rest);
  const T out = less_one / (less_one + T(2.0));
  return number<T>(words(out) | (words(x) & Words<T>(kSign)));
}

/// As FDLIBM's e_log.c: x = 2^k (1 + f) and ln(1 + f) from the series of artanh(f/(2 + f)).
template <class T>
T logarithm_of(const T& x) {
  constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcd;
  constexpr std::uint64_t kMantissa = (std::uint64_t{1} << kMantissaBits) - 1;
  constexpr double kTwo52 = 0x1p52;  // its bits and a small integer are 2^52 + that integer
  const Words<T> shifted = words(x) + Words<T>((kBias << kMantissaBits) - kRootOfHalf);
  const T k =
      number<T>((shifted >> kMantissaBits) | Words<T>(std::bit_cast<std::uint64_t>(kTwo52))) -
      T(kTwo52 + static_cast<double>(kBias));
  const T f = number<T>((shifted & Words<T>(kMantissa)) + Words<T>(kRootOfHalf)) - T(1.0);
  const T s = f / (T(2.0) + f), z = s * s, half_square = T(0.5) * f * f;
  const T series = z * polynomial(z, {6.666666666666735130e-01, 3.999999999940941908e-01,
                                      2.857142874366239149e-01, 2.222219843214978396e-01,
                                      1.818357216161805012e-01, 1.531383769920937332e-01,
                                      1.479819860511658591e-01});
  const T low = plus_product(s * (half_square + series), k, T(1.90821492927058770002e-10));
  const T out = plus_product(f - (half_square - low), k, T(6.93147180369123816490e-01));
  const T legal = select(x < T(0.0), T(kNan), select(x < T(kLeast), T(-kInfinity), out));
  return select(x < T(kInfinity), legal, x);
}

/// As FDLIBM's k_sin.c and k_cos.c, for |r| ≤ π/4, after x = r + k π/2.
template <class T>
Turn<T> turn_of_any(const T& x) {
  const T shifted = plus_product(T(kShift), x, T(0x1.45f306dc9c883p-1));
  const T k = shifted - T(kShift);
  T r = minus_product(x, k, T(0x1.921fb54442d18p+0));
  r = minus_product(r, k, T(0x1.1a62633145c07p-54));
  r = minus_product(r, k, T(-0x1.f1976b7ed8fbcp-110));
  const T z = r * r;
  const T sine =
      plus_product(r, r * z,
                   polynomial(z, {-1.66666666666666324348e-01, 8.33333333332248946124e-03,
                                  -1.98412698298579493134e-04, 2.75573137070700676789e-06,
                                  -2.50507602534068634195e-08, 1.58969099521155010221e-10}));
  const T tail = polynomial(
      z, {4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
          -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11});
  const T half = T(0.5) * z, most = T(1.0) - half;
  const T cosine = most + plus_product((T(1.0) - most) - half, z * z, tail);
  // k mod 4 says which of the two is the sine of x, and their signs.
  const T pairs = plus_product(T(kShift), k, T(0.5)) - T(kShift);
  const Mask<T> odd = T(2.0) * pairs != k;
  const Words<T> quarters = words(shifted);
  const auto with_sign = [](const T& value, const Words<T>& quarter) {
    return number<T>(words(value) ^ ((quarter & Words<T>(2)) << 62));
  };
  const Mask<T> legal = magnitude(x) <= T(1e9);
  return {select(legal, with_sign(select(odd, sine, cosine), quarters + Words<T>(1)), T(kNan)),
          select(legal, with_sign(select(odd, cosine, sine), quarters), T(kNan))};
}

/// As FDLIBM's s_atan.c, for |t| ≤ 7/16.
double small_arc_tangent(double t) {
  const double z = t * t;
  const double series = polynomial(
      z, {3.33333333333329318027e-01, -1.99999999998764832476e-01, 1.42857142725034663711e-01,
          -1.11111104054623557880e-01, 9.09088713343650656196e-02, -7.69187620504482999495e-02,
          6.66107313738753120669e-02, -5.83357013379057348645e-02, 4.97687799461593236017e-02,
          -3.65315727442169155270e-02, 1.62858201153657823623e-02});
  return minus_product(t, t * z, series);
}

}  // namespace

double exponential(double x) { return exponential_of(x); }
Lanes exponential(const Lanes& x) { return exponential_of(x); }
double logarithm(double x) { return logarithm_of(x); }
Lanes logarithm(const Lanes& x) { return logarithm_of(x); }
Turn<double> turn_of(double angle) { return turn_of_any(angle); }
Turn<Lanes> turn_of(const Lanes& angle) { return turn_of_any(angle); }
double hyperbolic_tangent(double x) { return hyperbolic_tangent_of(x); }
Lanes hyperbolic_tangent(const Lanes& x) { return hyperbolic_tangent_of(x); }

double angle_of(double x, double y) {
  const double a = std::abs(x), b = std::abs(y);
  const double least = lesser(a, b), most = greater(a, b);
  if (most == 0.0) return 0.0;
  const bool far = least > 0.4 * most;  // nearer to the diagonal than to the axis
  double angle = far ? std::numbers::pi / 4 + small_arc_tangent((least - most) / (least + most))
                     : small_arc_tangent(least / most);
  if (b > a) angle = std::numbers::pi / 2 - angle;
  if (x < 0.0) angle = std::numbers::pi - angle;
  return y < 0.0 ? -angle : angle;
}

}  // namespace rtg
