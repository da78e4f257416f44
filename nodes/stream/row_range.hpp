#pragma once

#include <cstdint>

namespace rtg::stream {

/// Half-open range of rows. A row is one transition of the stream; rows are numbered from 0.
struct RowRange {
  std::int64_t begin = 0, end = 0;

  bool operator==(const RowRange&) const = default;
};

}  // namespace rtg::stream
