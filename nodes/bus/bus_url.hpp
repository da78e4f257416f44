#pragma once

#include <string>

namespace rtg::bus {

/// Size of the UDP receive buffer [bytes]. The kernel's default of 208 kB overflows in every burst.
inline constexpr int kReceiveBuffer = 4 << 20;

/// Returns `url` with explicit ttl and receive buffer size, "memq://" unchanged. Throws
/// std::invalid_argument that lists the legal URLs if `url` is not legal.
std::string checked_bus_url(const std::string& url);

}  // namespace rtg::bus
