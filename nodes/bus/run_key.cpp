#include "nodes/bus/run_key.hpp"

#include <sodium.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "nodes/bus/content_hash.hpp"
#include "nodes/files/atomic_file.hpp"
#include "nodes/files/regular_file.hpp"

namespace rtg::bus {
namespace {

constexpr std::size_t kLongestFile = 4096;  // bytes
constexpr std::size_t kSecretDigits = 64;
constexpr std::size_t kBeforeName = kSecretDigits + 1 + 2 * RunKey::kTagBytes + 1;  // characters

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string digits(2 * bytes.size() + 1, '\0');
  sodium_bin2hex(digits.data(), digits.size(), bytes.data(), bytes.size());
  digits.pop_back();  // the final NUL
  return digits;
}

}  // namespace

std::int64_t run_id(const std::string& name) { return ContentHash().add(name).value(); }

std::optional<std::span<const std::uint8_t>> without_tag(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < RunKey::kTagBytes) return std::nullopt;
  return bytes.first(bytes.size() - RunKey::kTagBytes);
}

RunKey::RunKey(const Secret& secret, std::string name) : secret_(secret), name_(std::move(name)) {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be initialised");
}

RunKey RunKey::random(const std::string& name) {
  RunKey key({}, name);
  randombytes_buf(key.secret_.data(), key.secret_.size());
  return key;
}

RunKey RunKey::read(const std::filesystem::path& file) {
  const std::string legal =
      "; legal: the key file of a run, which its owner alone can read, or none, for a new key";
  const files::Content content =
      files::read_regular(file, kLongestFile, files::Readers::kOwnerAlone);
  if (!content.defect.empty())
    throw std::invalid_argument(file.string() + ": " + content.defect + legal);
  // The file must be the one that write() makes of what stands in it.
  const std::string& text = content.text;
  Secret secret{};
  sodium_hex2bin(secret.data(), secret.size(), text.data(), std::min(text.size(), kSecretDigits),
                 nullptr, nullptr, nullptr);
  const RunKey key(secret, text.size() > kBeforeName + 1
                               ? text.substr(kBeforeName, text.size() - kBeforeName - 1)
                               : std::string());
  if (key.name_.empty() || key.name_.find('\n') != std::string::npos || key.line() != text)
    throw std::invalid_argument(file.string() +
                                ": is no key file, or was changed since it was written" + legal);
  return key;
}

void RunKey::write(const std::filesystem::path& file) const {
  files::write_atomically(file, line(), 0600);
}

std::string RunKey::line() const {
  const Tag check = tag("", {reinterpret_cast<const std::uint8_t*>(name_.data()), name_.size()});
  return hex(secret_) + " " + hex(check) + " " + name_ + "\n";
}

RunKey::Tag RunKey::tag(std::string_view channel, std::span<const std::uint8_t> bytes) const {
  Tag tag{};
  crypto_generichash_state state;
  crypto_generichash_init(&state, secret_.data(), secret_.size(), tag.size());
  const std::string name(channel);  // its final NUL parts it from the bytes
  crypto_generichash_update(&state, reinterpret_cast<const std::uint8_t*>(name.c_str()),
                            name.size() + 1);
  crypto_generichash_update(&state, bytes.data(), bytes.size());
  crypto_generichash_final(&state, tag.data(), tag.size());
  return tag;
}

void RunKey::seal(std::string_view channel, std::vector<std::uint8_t>& bytes) const {
  const Tag end = tag(channel, bytes);
  bytes.insert(bytes.end(), end.begin(), end.end());
}

std::optional<std::span<const std::uint8_t>> RunKey::opened(
    std::string_view channel, std::span<const std::uint8_t> bytes) const {
  const auto message = without_tag(bytes);
  if (!message) return std::nullopt;
  const Tag right = tag(channel, *message);
  const auto found = bytes.last(kTagBytes);
  if (sodium_memcmp(right.data(), found.data(), kTagBytes) != 0) return std::nullopt;
  return message;
}

}  // namespace rtg::bus
