// One push that moves an object, in each forward simulator.

#include <benchmark/benchmark.h>

#include <memory>

#include "core/forward/newton_simulator.hpp"
#include "core/search/predecessor.hpp"
#include "tests/bench/gathering_states.hpp"

namespace rtg::bench {
namespace {

using testing::gathering;

struct Push {
  Poses start;
  int action = 0;
};

/// All pushes from the goal states that both simulators finish and that move an object.
std::vector<Push> contact_pushes(const tasks::Task& task) {
  const forward::Box2dSimulator box2d(task.scene, task.push, {});
  const forward::NewtonSimulator newton(task.scene, task.push, {});
  std::vector<Push> pushes;
  for (const Poses& state : bench::goal_states(task))
    for (int action = 0; action < task.push.headings; ++action) {
      const forward::PushOutcome outcome = box2d.push(state, action);
      if (outcome.ok && search::objects_moved(state, outcome.end) > 0 &&
          newton.push(state, action).ok)
        pushes.push_back({state, action});
    }
  return pushes;
}

template <class Forward>
void push(benchmark::State& state) {
  const tasks::Task task = gathering();
  const std::vector<Push> pushes = contact_pushes(task);
  if (pushes.empty()) return state.SkipWithError("no push moves an object");
  const Forward simulator(task.scene, task.push, {});
  std::size_t k = 0;
  for (auto _ : state) {
    const Push& next = pushes[k++ % pushes.size()];
    const forward::PushOutcome outcome = simulator.push(next.start, next.action);
    if (!outcome.ok) return state.SkipWithError("a push failed");
    benchmark::DoNotOptimize(outcome.end.data());
  }
}

BENCHMARK(push<forward::Box2dSimulator>)->Name("push/box2d")->Unit(benchmark::kMicrosecond);
BENCHMARK(push<forward::NewtonSimulator>)->Name("push/newton")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rtg::bench
