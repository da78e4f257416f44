#include "nodes/beam_coordinator/row_digest.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace rtg::beam_coordinator {
namespace {

static_assert(std::endian::native == std::endian::little);

using Bytes = std::vector<std::uint8_t>;

template <class Number>
void append(Bytes& bytes, Number number) {
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(Number)>>(number);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

void append(Bytes& bytes, const Poses& poses) {
  for (const Pose& pose : poses)
    for (const double entry : {pose.x, pose.y, pose.theta}) append(bytes, entry);
}

}  // namespace

void RowDigest::add(std::span<const search::Transition> rows) {
  Bytes bytes;
  for (const search::Transition& row : rows) {
    append(bytes, row.poses);
    append(bytes, std::int32_t{row.action});
    append(bytes, row.next);
    append(bytes, static_cast<std::int8_t>(row.success));
    append(bytes, static_cast<std::int8_t>(row.source));
  }
  sum_.add(bytes);
}

}  // namespace rtg::beam_coordinator
