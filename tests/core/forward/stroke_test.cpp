// Pushes along any way of the robot, not only those of the actions.

#include <gtest/gtest.h>

#include "core/forward/box2d_simulator.hpp"
#include "core/forward/newton_simulator.hpp"
#include "tests/support/random_push.hpp"

namespace rtg::forward {
namespace {

template <class AnySimulator>
class Strokes : public ::testing::Test {};

using Simulators = ::testing::Types<Box2dSimulator, NewtonSimulator>;
TYPED_TEST_SUITE(Strokes, Simulators);

// A stride that is not among the simulator's gives what a simulator with that stride gives.
TYPED_TEST(Strokes, OfAnyLengthAreThoseOfAnActionSetThatHasIt) {
  const PhysicsConfig physics;
  const PushConfig push;
  PushConfig shorter = push;
  shorter.strides = {1.3};
  int moved = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const testing::RandomPush drawn = testing::random_push(seed, push, true);
    const PushOutcome expected =
        TypeParam(drawn.scene, shorter, physics).push(drawn.start, drawn.action);
    const PushOutcome found = TypeParam(drawn.scene, push, physics)
                                  .push_along(drawn.start, {direction(drawn.action, push), 1.3});
    EXPECT_EQ(found.ok, expected.ok) << seed;
    EXPECT_EQ(found.end, expected.end) << seed;
    moved += found.end[1] != drawn.start[1];
  }
  EXPECT_GT(moved, 3);
}

TYPED_TEST(Strokes, GoInAnyDirection) {
  const testing::RandomPush drawn = testing::random_push(1, PushConfig{}, true);
  Scene alone = drawn.scene;
  alone.bodies.resize(1);
  alone.joints.clear();
  const Vector2d way = Vector2d(0.123, -0.456);
  const PushOutcome found = TypeParam(alone, PushConfig{}, PhysicsConfig{})
                                .push_along({{1.0, 2.0, 0.3}}, {way.normalized(), way.norm()});
  EXPECT_TRUE(found.ok);
  EXPECT_NEAR(found.end[0].x, 1.123, 1e-3);
  EXPECT_NEAR(found.end[0].y, 1.544, 1e-3);
}

}  // namespace
}  // namespace rtg::forward
