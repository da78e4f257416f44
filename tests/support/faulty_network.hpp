#pragma once

#include <functional>
#include <map>

#include "core/math/rng.hpp"

namespace rtg::testing {

/// A network in virtual time that loses, doubles and reorders, the same way for the same seed.
class FaultyNetwork {
 public:
  struct Faults {
    double loss = 0.2, twice = 0.1;
    double delay = 0.05;  // [s], uniform, so messages overtake each other
  };

  FaultyNetwork(const Faults& faults, Rng& rng) : faults_(faults), rng_(rng) {}

  void send(double now, const std::function<void()>& deliver) {
    const int copies = rng_.uniform(0, 1) < faults_.twice ? 2 : 1;
    for (int i = 0; i < copies; ++i)
      if (rng_.uniform(0, 1) >= faults_.loss)
        flying_.emplace(now + rng_.uniform(0, faults_.delay), deliver);
  }

  /// Delivers everything that arrives until `now`.
  void run(double now) {
    while (!flying_.empty() && flying_.begin()->first <= now) {
      const auto deliver = flying_.begin()->second;
      flying_.erase(flying_.begin());
      deliver();
    }
  }

 private:
  Faults faults_;
  Rng& rng_;
  std::multimap<double, std::function<void()>> flying_;
};

}  // namespace rtg::testing
