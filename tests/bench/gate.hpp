#pragma once

#include <cstdio>
#include <string>

namespace rtg::bench {

enum class Bound { kAtLeast, kAtMost };

/// Prints the line of a gate. Returns whether it holds.
inline bool gate(const std::string& name, double value, Bound relation, double bound) {
  const bool least = relation == Bound::kAtLeast;
  const bool passed = least ? value >= bound : value <= bound;
  std::printf("gate %s %.4g %s%g %s\n", name.c_str(), value, least ? ">=" : "<=", bound,
              passed ? "PASS" : "FAIL");
  return passed;
}

}  // namespace rtg::bench
