#pragma once

#include <exception>

namespace rtg::beam_coordinator {

/// Exception that ends the search when the process has been asked to end.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace rtg::beam_coordinator
