#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "nodes/bus/run_key.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/target.hpp"

namespace rtg::fuzz {

/// Returns a key that is the same in all processes, so that a sealed message can be a seed.
inline const bus::RunKey& fixed_key() {
  static const bus::RunKey key = [] {
    const ScratchFile file("key");
    file.write(bytes_of(std::string(64, '5') + " fuzz\n"));
    return bus::RunKey::read(file.path);
  }();
  return key;
}

/// Returns the datagram that carries `payload`.
inline Bytes datagram_of(std::string_view channel, std::span<const std::uint8_t> payload) {
  Bytes bytes{'L', 'C', '0', '2', 0, 0, 0, 1};
  bytes.insert(bytes.end(), channel.begin(), channel.end());
  bytes.push_back(0);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

}  // namespace rtg::fuzz
