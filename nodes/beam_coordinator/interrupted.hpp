#pragma once

#include <exception>

namespace rtg::beam_coordinator {

/// Ends a generation from within when the process has been asked to end.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace rtg::beam_coordinator
