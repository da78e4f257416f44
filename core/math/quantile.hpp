#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rtg {

/// The value that the share `share` ∈ [0, 1] of `values` does not exceed, the nearest one; 0 of
/// none.
template <class Number>
double quantile(std::vector<Number> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

}  // namespace rtg
