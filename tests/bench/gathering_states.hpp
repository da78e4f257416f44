#pragma once

#include <stdexcept>
#include <vector>

#include "core/forward/box2d_simulator.hpp"
#include "core/tasks/goal_sampler.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::bench {

inline constexpr int kStates = 8;

/// Goal states of Gathering at rest, what the first layer of a beam search works on.
inline std::vector<Poses> goal_states(const tasks::Task& task) {
  const forward::Box2dSimulator box2d(task.scene, task.push, {});
  Rng rng(1);
  std::vector<Poses> states;
  while (states.size() < kStates) {
    const auto drawn = sample_goal(task, rng);
    if (!drawn) throw std::runtime_error("the task has no goal states");
    const forward::PushOutcome rest = box2d.settle(*drawn);
    if (rest.ok && succeeded(task, rest.end)) states.push_back(rest.end);
  }
  return states;
}

}  // namespace rtg::bench
