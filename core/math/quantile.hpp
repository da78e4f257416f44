#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rtg {

/// Returns the quantile of `values` at the fraction `share` ∈ [0, 1]: the value of the nearest
/// rank, without interpolation. Returns 0 if there are no values.
template <class Number>
double quantile(std::vector<Number> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

}  // namespace rtg
