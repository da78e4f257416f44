#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace rtg::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// Returns legal inputs of the target, from which its inputs are made by changes. Each target
/// defines it, beside LLVMFuzzerTestOneInput().
std::vector<Bytes> seeds();

/// Ends the process if a fact does not hold, in every build; the input in work is the reproducer.
inline void require(bool holds, const std::string& fact) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", fact.c_str());
  std::abort();
}

inline Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

}  // namespace rtg::fuzz

/// Passes `data` to the code under test and requires what holds for all bytes. Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
