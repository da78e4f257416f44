#pragma once

#include <span>
#include <string>

#include "core/search/transition.hpp"
#include "nodes/files/sha256.hpp"

namespace rtg::beam_coordinator {

/// The SHA-256 of transitions one after another, of each: poses [bodies × 3] float64, action int32,
/// next poses, success int8, source int8, little-endian. Consumers of the stream compute the same
/// (train/rtg/files/row_digest.py).
class RowDigest {
 public:
  void add(std::span<const search::Transition> rows);
  /// Returns the digest of the rows so far, as hexadecimal digits.
  std::string hex() const { return sum_.hex(); }

 private:
  files::Sha256 sum_;
};

}  // namespace rtg::beam_coordinator
