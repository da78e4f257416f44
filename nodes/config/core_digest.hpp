#pragma once

#include <string_view>

namespace rtg::config {

/// Returns the SHA-256 of the compiled core, in hexadecimal digits. Programs with equal cores
/// generate equal transitions.
std::string_view core_digest();

}  // namespace rtg::config
