#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/math/rng.hpp"

namespace rtg {

/// Draws `count` elements of `from` at random, without replacement and in random order. Returns all
/// elements, in random order, if there are fewer.
template <class T>
std::vector<T> drawn(std::vector<T> from, int count, Rng& rng) {
  const int size = static_cast<int>(from.size());
  const int most = std::clamp(count, 0, size);
  for (int k = 0; k < most; ++k)
    std::swap(from[static_cast<std::size_t>(k)],
              from[static_cast<std::size_t>(k + rng.below(size - k))]);
  from.resize(static_cast<std::size_t>(most));
  return from;
}

}  // namespace rtg
