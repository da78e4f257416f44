// Prints from how many states one push leads to a goal state of a task, and Box2D's clock.
#include <box2d/b2_timer.h>

#include <cstdio>
#include <thread>

#include "core/reverse/reverse_simulator.hpp"
#include "core/tasks/goal_sampler.hpp"
#include "nodes/config/config.hpp"

int main(int, char** words) {
  const rtg::config::Config config = rtg::config::load_config(words[1]);
  const rtg::tasks::Task& task = config.task;
  const rtg::reverse::ReverseSimulator simulator(task.scene, config.physics, task.push,
                                                 config.reverse);
  rtg::Rng rng(1);
  const std::optional<rtg::Poses> goal = rtg::tasks::sample_goal(task, rng);
  int found = 0;
  for (int action = 0; goal && action < task.push.headings; ++action)
    found += !simulator.solve({*goal, action}).predecessors.empty();
  const b2Timer timer;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::printf("%d states, %d ms\n", found, static_cast<int>(timer.GetMilliseconds()));
}
