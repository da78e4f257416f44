#pragma once

namespace rtg::bus {

/// A time of a clock that is never set back, or a span of time [s].
using Seconds = double;

}  // namespace rtg::bus
