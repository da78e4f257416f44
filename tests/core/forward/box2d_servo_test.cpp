// How fast the servo moves the robot, and that it arrives.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/forward/box2d_simulator.hpp"

namespace rtg::forward {
namespace {

const Poses kBelowABox{{0, 0, 0}, {1.3, 1.0, 0}};  // their sides overlap by 0.1 m seen along +x

/// A robot box and one more box.
Scene robot_and_box() {
  return {{{"robot", "robot", box(1.0, 1.0), 1.0, 0.5, false},
           {"box", "box", box(1.2, 1.2), 1.0, 0.5, false}}};
}

/// Holds the robot's fastest motion within one Box2D step, in units of the advance at push speed
/// (turns: at the corners).
struct Fastest {
  double way = 0.0, turn = 0.0;
};

/// Measures it over the pushes from `kBelowABox` along +x whose path the arena cuts off after 1, 2,
/// ... 50 Box2D steps: a robot that lags behind does the same in the longer ones and then one step
/// more.
Fastest fastest(const Scene& scene, const PhysicsConfig& physics) {
  const double advance = longest_stride(PushConfig{}) / (physics.sub_steps * physics.box2d_steps);
  Fastest most;
  Pose before = kBelowABox[0];
  for (int k = 1; k <= physics.sub_steps * physics.box2d_steps; ++k) {
    PushConfig push;
    push.arena = k * advance;
    const PushOutcome out = Box2dSimulator(scene, push, physics).push(kBelowABox, 0);
    EXPECT_TRUE(out.ok);
    const Pose now = out.end[0];
    if (k > 1)  // the first one brings the steps of the catching up along
      most.way = std::max(most.way, (now.position() - before.position()).norm() / advance);
    most.turn = std::max(
        most.turn, std::abs(now.theta - before.theta) * scene.bodies[0].shape.radius() / advance);
    before = now;
  }
  return most;
}

constexpr double kBound = 1.5;       // of the servo
constexpr double kCorrection = 0.3;  // by Box2D, of bodies that touch too deeply

// The robot pushes a heavy box off centre, until that has turned out of its way.
TEST(Box2dServo, ARobotThatComesFreeDoesNotJump) {
  Scene scene = robot_and_box();
  scene.bodies[1].density = 10.0;
  const Fastest most = fastest(scene, {});
  EXPECT_LT(most.way, kBound + kCorrection);
  EXPECT_GT(most.way, 1.4) << "it never came free";
}

// The corner of a fixed box turns a weak robot, which then turns back.
TEST(Box2dServo, ARobotThatAContactHasTurnedTurnsBackAtTheSpeedOfThePush) {
  Scene scene = robot_and_box();
  scene.bodies[1].fixed = true;
  PhysicsConfig physics;
  physics.torque_factor = 2.0;
  const Fastest most = fastest(scene, physics);
  EXPECT_LT(most.turn, kBound + kCorrection);
  EXPECT_GT(most.turn, 1.4) << "it never turned";
}

// A box that it meets in the last steps of its path holds the robot up by up to a third of a step.
TEST(Box2dServo, ARobotHeldUpAtTheEndOfItsPathCatchesUp) {
  for (const double gap : {1.9, 1.95}) {
    const PushOutcome out =
        Box2dSimulator(robot_and_box(), {}, {}).push({{0, 0, 0}, {1.1 + gap, 0, 0}}, 0);
    ASSERT_TRUE(out.ok);
    EXPECT_NEAR(out.end[0].x, 2.0, 1e-3) << gap;
  }
}

// Robot and box weigh 24 times the robot. The servo's largest force is force_factor (1 + 1/k_D)
// times the robot's drag at push speed: it moves both at force_factor (1 + 1/k_D) / 24 of that
// speed once they have caught up, within 0.05 s of the push's 0.5 s; as long they coast afterwards.
TEST(Box2dServo, AHeavyBoxMovesAsFastAsTheLargestForceMovesIt) {
  Scene scene = robot_and_box();
  scene.bodies[1].density = 23.0 / (1.2 * 1.2);
  PhysicsConfig physics;
  for (const auto& [inertia, damping] : {std::pair(false, 20.0), {true, 1.0}, {true, 0.5}}) {
    physics.inertia = inertia;
    physics.damping = damping;
    const double speed = 6.0 * (1.0 + physics.inertia_weight()) / 24.0;
    const PushOutcome out = Box2dSimulator(scene, {}, physics).push({{0, 0, 0}, {1.1, 0, 0}}, 0);
    ASSERT_TRUE(out.ok);
    EXPECT_NEAR(out.end[1].x - 1.1, speed * longest_stride(PushConfig{}), 0.1) << damping;
  }
}

}  // namespace
}  // namespace rtg::forward
