#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rtg::bus {

/// Returns the value of `header.run` in the messages of the run named `name`: a hash, no secret.
std::int64_t run_id(const std::string& name);

/// The secret that the processes of a run share. It authenticates their messages: each ends in a
/// keyed BLAKE2b hash (RFC 7693) of 16 bytes over its channel and its bytes. LCM's decoders ignore
/// these, so that lcm-spy and lcm-logger read the messages.
///
/// A key file has one line: the key as 64 hexadecimal digits, the tag of the run's name on no
/// channel, by which damage is seen, and that name. It is read only if nobody but its owner can
/// read it.
class RunKey {
 public:
  static constexpr std::size_t kTagBytes = 16;

  /// Draws a key for the run named `name`.
  static RunKey random(const std::string& name);
  /// Throws std::invalid_argument that names `file` if it is no key file, is another user's, or
  /// others can read it.
  static RunKey read(const std::filesystem::path& file);
  /// Replaces `file` by a key file with the mode 0600. Throws std::system_error that names `file`.
  void write(const std::filesystem::path& file) const;

  const std::string& name() const { return name_; }

  /// Appends the tag of `bytes` to them.
  void seal(std::string_view channel, std::vector<std::uint8_t>& bytes) const;
  /// Returns `bytes` without the tag, or nothing if the tag is not that of this key.
  std::optional<std::span<const std::uint8_t>> opened(std::string_view channel,
                                                      std::span<const std::uint8_t> bytes) const;

 private:
  using Secret = std::array<std::uint8_t, 32>;
  using Tag = std::array<std::uint8_t, kTagBytes>;

  RunKey(const Secret& secret, std::string name);
  Tag tag(std::string_view channel, std::span<const std::uint8_t> bytes) const;
  std::string line() const;  // of its file

  Secret secret_;
  std::string name_;
};

/// Returns the bytes of a sealed message without their tag, which is not checked; nothing if they
/// are too short.
std::optional<std::span<const std::uint8_t>> without_tag(std::span<const std::uint8_t> bytes);

}  // namespace rtg::bus
