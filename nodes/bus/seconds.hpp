#pragma once

namespace rtg::bus {

/// A time of a monotonic clock, or a duration [s].
using Seconds = double;

}  // namespace rtg::bus
