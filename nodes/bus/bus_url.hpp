#pragma once

#include <string>

namespace rtg::bus {

/// The kernel's default of 208 kB loses every burst [bytes].
inline constexpr int kReceiveBuffer = 4 << 20;

/// The URL with ttl and receive buffer spelt out; throws std::invalid_argument that says what is
/// legal.
std::string checked_bus_url(const std::string& url);

}  // namespace rtg::bus
