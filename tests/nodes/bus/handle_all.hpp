#pragma once

#include "nodes/bus/bus.hpp"

namespace rtg::testing {

/// Handles messages until no more are there.
inline void handle_all(bus::Bus& bus) {
  while (bus.spin(std::chrono::milliseconds(0)) > 0) {
  }
}

}  // namespace rtg::testing
