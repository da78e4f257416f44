#pragma once

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
    file.write(bytes_of(std::string(64, '5') + " 7ee57b36aa205413ca410423ea6ca368 fuzz\n"));
    return bus::RunKey::read(file.path);
  }();
  return key;
}

/// Returns the datagram that carries `payload`.
inline Bytes datagram_of(std::string_view channel, std::span<const std::uint8_t> payload) {
  std::string text("LC02\0\0\0\1", 8);
  text.append(channel) += '\0';
  text.append(payload.begin(), payload.end());
  return bytes_of(text);
}

}  // namespace rtg::fuzz
