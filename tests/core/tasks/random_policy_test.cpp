#include <gtest/gtest.h>

#include "core/forward/box2d_simulator.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::tasks {
namespace {

using testing::gathering;

bool moved_object(const Poses& before, const Poses& after) {
  for (std::size_t i = 1; i < before.size(); ++i)
    if ((after[i].position() - before[i].position()).norm() > 0.05) return true;
  return false;
}

// Gathering must be out of reach of exploration; a throwaway model of the task
// touched an object in 5 to 12.6 % of random steps.
TEST(RandomPolicy, NeverGathersAndSeldomTouches) {
  const Task task = gathering();
  const forward::Box2dSimulator simulator(task.scene, task.push, PhysicsConfig{});
  int successes = 0, steps = 0, touching = 0;
  for (std::uint64_t episode = 0; episode < 200; ++episode) {
    Rng rng(42, episode);
    Poses poses = task.start;
    for (int k = 0; k < task.horizon; ++k, ++steps) {
      const forward::PushOutcome out = simulator.push(poses, rng.below(task.push.headings));
      ASSERT_TRUE(out.ok);
      touching += moved_object(poses, out.end);
      poses = out.end;
      successes += succeeded(task, poses);
    }
  }
  EXPECT_EQ(successes, 0);
  const double share = static_cast<double>(touching) / steps;
  EXPECT_GT(share, 0.05);
  EXPECT_LT(share, 0.13);
}

}  // namespace
}  // namespace rtg::tasks
