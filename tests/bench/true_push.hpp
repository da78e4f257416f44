#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "core/forward/box2d_simulator.hpp"
#include "core/reverse/problem/reverse_job.hpp"
#include "core/tasks/contact_heading.hpp"

namespace rtg::bench {

inline constexpr double kPushed = 0.5;  // least displacement of an object in the pushes drawn [m]
inline constexpr int kWalk = 20;        // pushes from one start at most
inline constexpr std::size_t kTries = 1000;  // pushes made for one drawn, on the average, at most

/// Returns the largest displacement of an object [m].
inline double largest_displacement(const Poses& a, const Poses& b) {
  double most = 0.0;
  for (std::size_t k = 1; k < a.size(); ++k)
    most = std::max(most, (a[k].position() - b[k].position()).norm());
  return most;
}

/// A push of Box2D, as the reverse job that asks for it.
struct TruePush {
  reverse::ReverseJob job;
  double displacement = 0.0;  // largest_displacement() [m]
};

/// Draws pushes that move an object by kPushed or more, from contact-seeking walks. Throws
/// std::runtime_error if hardly any push does.
inline std::vector<TruePush> draw_pushes(const tasks::Task& task, const forward::Simulator& box2d,
                                         std::size_t count) {
  Rng rng(1);
  std::vector<TruePush> pushes;
  std::size_t made = 0;
  while (pushes.size() < count) {
    Poses state = jittered_start(task, task.start_jitter, rng);
    for (int step = 0; step < kWalk && pushes.size() < count; ++step) {
      if (++made > kTries * count)
        throw std::runtime_error("task " + task.name + ": too few pushes move an object by 0.5 m");
      const int action = contact_heading(task, state, rng);
      const forward::PushOutcome after = box2d.push(state, action);
      if (!after.ok) break;
      const double displacement = largest_displacement(state, after.end);
      if (displacement >= kPushed) pushes.push_back({{after.end, action}, displacement});
      state = after.end;
    }
  }
  return pushes;
}

}  // namespace rtg::bench
