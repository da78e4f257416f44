#include <sleef.h>

#include "core/math/elementary_lanes.hpp"

namespace rtg {

double exponential(double x) { return Sleef_finz_expd1_u10purecfma(x); }
double logarithm(double x) { return Sleef_finz_logd1_u35purecfma(x); }
double hyperbolic_tangent(double x) { return Sleef_finz_tanhd1_u35purecfma(x); }
double angle_of(double x, double y) { return Sleef_finz_atan2d1_u35purecfma(y, x); }
Turn<double> turn_of(double angle) {
  const auto [s, c] = Sleef_finz_sincosd1_u35purecfma(angle);
  return {c, s};
}

#if defined(__AVX512F__)
Lanes exponential(const Lanes& x) { return Lanes(Sleef_finz_expd8_u10avx512f(Register(x))); }
Lanes logarithm(const Lanes& x) { return Lanes(Sleef_finz_logd8_u35avx512f(Register(x))); }
Lanes hyperbolic_tangent(const Lanes& x) {
  return Lanes(Sleef_finz_tanhd8_u35avx512f(Register(x)));
}
Turn<Lanes> turn_of(const Lanes& angle) {
  const auto [s, c] = Sleef_finz_sincosd8_u35avx512f(Register(angle));
  return {Lanes(c), Lanes(s)};
}
#elif defined(__AVX2__)
Lanes exponential(const Lanes& x) { return Lanes(Sleef_finz_expd4_u10avx2(Register(x))); }
Lanes logarithm(const Lanes& x) { return Lanes(Sleef_finz_logd4_u35avx2(Register(x))); }
Lanes hyperbolic_tangent(const Lanes& x) { return Lanes(Sleef_finz_tanhd4_u35avx2(Register(x))); }
Turn<Lanes> turn_of(const Lanes& angle) {
  const auto [s, c] = Sleef_finz_sincosd4_u35avx2(Register(angle));
  return {Lanes(c), Lanes(s)};
}
#else
Lanes exponential(const Lanes& x) {
  return Lanes([&](auto l) { return exponential(double(x[l])); });
}
Lanes logarithm(const Lanes& x) {
  return Lanes([&](auto l) { return logarithm(double(x[l])); });
}
Lanes hyperbolic_tangent(const Lanes& x) {
  return Lanes([&](auto l) { return hyperbolic_tangent(double(x[l])); });
}
Turn<Lanes> turn_of(const Lanes& angle) {
  return {Lanes([&](auto l) { return turn_of(double(angle[l])).c; }),
          Lanes([&](auto l) { return turn_of(double(angle[l])).s; })};
}
#endif

}  // namespace rtg
