#include "core/forward/box2d_simulator.hpp"

#include <box2d/box2d.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <thread>

#include "core/math/rng.hpp"
#include "core/tasks/goal_sampler.hpp"
#include "core/world/separation.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::forward {
namespace {

using testing::gathering;

const PhysicsConfig kPhysics;
const PushConfig kPush;

Box2dSimulator simulator_of(const tasks::Task& task) { return {task.scene, task.push, kPhysics}; }

/// A robot box at the left of one box, pushed by action 0 (along +x).
Scene robot_and_box() {
  return {{{"robot", "robot", box(1.0, 1.0), 1.0, 0.5, false},
           {"box", "box", box(1.2, 1.2), 1.0, 0.5, false}}};
}

/// Starts from which a push touches zero, one or more boxes.
std::vector<Poses> varied_starts(const tasks::Task& task, int count) {
  std::vector<Poses> starts;
  Rng rng(11);
  while (starts.size() < static_cast<std::size_t>(count)) {
    const auto goal = sample_goal(task, rng);
    if (goal) starts.push_back(*goal);
  }
  return starts;
}

TEST(Box2dSimulator, EqualPushesGiveEqualBitsInAnyOrderOnAnyThread) {
  const tasks::Task task = gathering();
  const Box2dSimulator simulator = simulator_of(task);
  const std::vector<Poses> starts = varied_starts(task, 40);
  std::vector<Poses> alone, mixed(starts.size());
  for (std::size_t k = 0; k < starts.size(); ++k)
    alone.push_back(simulator_of(task).push(starts[k], static_cast<int>(k)).end);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t k = starts.size(); k-- > 0;)
        if (k % 4 == t) mixed[k] = simulator.push(starts[k], static_cast<int>(k)).end;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(alone, mixed);
}

TEST(Box2dSimulator, MovedBodiesHaveSinglePrecisionPosesSoChainsReproduce) {
  const tasks::Task task = gathering();
  const Box2dSimulator simulator = simulator_of(task);
  for (const Poses& start : varied_starts(task, 20)) {
    const Poses middle = simulator.push(start, 5).end;
    for (const Pose& pose : middle) EXPECT_EQ(pose, to_single(pose));
    EXPECT_EQ(simulator.push(middle, 29).end, simulator.push(middle, 29).end);
  }
}

TEST(Box2dSimulator, AFreePushEndsAtTheTargetWithTheHeadingHeld) {
  const tasks::Task task = gathering();
  const Box2dSimulator simulator = simulator_of(task);
  Poses start = task.start;
  start[0] = {6.0, -6.5, 0.4};
  for (int action = 0; action < 48; ++action) {
    const PushOutcome out = simulator.push(start, action);
    const Pose target = push_target(start[0], stroke_of(action, task.push),
                                    task.push);  // clipped for some of the actions
    ASSERT_TRUE(out.ok);
    EXPECT_NEAR(out.end[0].x, target.x, 1e-5);
    EXPECT_NEAR(out.end[0].y, target.y, 1e-5);
    EXPECT_NEAR(out.end[0].theta, target.theta, 1e-6);
  }
}

// With bodies near the path the push is stepped through, without any the result is known; both must
// agree.
TEST(Box2dSimulator, APushCloselyPastABodyEndsAtTheTargetToo) {
  const tasks::Task task = gathering();
  Poses start = task.start;
  start[0] = {0.0, 0.0, 0.0};
  start[1] = {1.0, 0.8 * std::sqrt(0.75) + 0.6 + 0.03, 0.0};  // 0.03 from the hexagon's upper side
  const PushOutcome out = simulator_of(task).push(start, 0);
  ASSERT_TRUE(out.ok);
  EXPECT_NEAR(out.end[0].x, 2.0, 1e-5);
  EXPECT_NEAR(out.end[0].y, 0.0, 1e-5);
  EXPECT_EQ(out.end[1], start[1]);
}

TEST(Box2dSimulator, APushedBoxPushesTheNext) {
  Scene scene = robot_and_box();
  scene.bodies.push_back(scene.bodies[1]);
  scene.bodies.push_back(scene.bodies[1]);
  const Poses start{{0, 0, 0}, {1.2, 0, 0}, {2.6, 0, 0}, {5.9, 0, 0}};
  const PushOutcome out = Box2dSimulator(scene, kPush, kPhysics).push(start, 0);
  ASSERT_TRUE(out.ok);
  EXPECT_NEAR(out.end[1].x, 2.0 + 1.1 + 0.02, 0.02);
  EXPECT_NEAR(out.end[2].x, out.end[1].x + 1.2 + 0.02, 0.02);
  EXPECT_EQ(out.end[3], start[3]);
}

TEST(Box2dSimulator, UntouchedBodiesKeepTheirPosesBitForBit) {
  const tasks::Task task = gathering();
  const Box2dSimulator simulator = simulator_of(task);
  Poses start = task.start;
  start[1].theta = std::numbers::pi;  // not a single-precision number
  for (int action = 24; action < 48; ++action) {
    const PushOutcome out = simulator.push(start, action);
    ASSERT_TRUE(out.ok);
    for (std::size_t i = 1; i < start.size(); ++i) EXPECT_EQ(out.end[i], start[i]);
  }
}

TEST(Box2dSimulator, UntouchedBodiesInContactDoNotCreep) {
  const tasks::Task task = gathering();
  Poses start = task.start;
  start[1] = {-3.0, 3.0, 0.0};
  start[2] = {-3.0 + 1.2 + 0.008, 3.0,
              0.0};  // deeper in contact than the position correction leaves it
  EXPECT_EQ(simulator_of(task).push(start, 36).end[2], start[2]);
}

// Reference/physics.md 2.3: pushed at steady speed v, then let go, a body coasts on for v/d, d =
// k_D/Δt, because every Box2D step divides its velocity by 1 + h d and moves it by what is left: h
// v Σ (1 + h d)^-k = v/d.
TEST(Box2dSimulator, APushedBoxStopsAtTheRobotsFacePlusSkinPlusCoasting) {
  const Box2dSimulator simulator(robot_and_box(), kPush, kPhysics);
  const double speed = longest_stride(kPush) / (kPhysics.sub_steps * kPhysics.time_step);
  const double coasting = speed * kPhysics.time_step / kPhysics.damping;
  for (const double gap : {0.02, 0.1, 0.313, 0.8}) {
    const PushOutcome out = simulator.push({{0, 0, 0}, {1.1 + gap, 0, 0}}, 0);
    ASSERT_TRUE(out.ok);
    EXPECT_NEAR(out.end[0].x, 2.0, 1e-3);
    EXPECT_NEAR(out.end[1].y, 0.0, 1e-3);
    const double rest = out.end[1].x - out.end[0].x - 1.1;
    EXPECT_GE(rest - coasting, 0.0145) << gap;  // Box2D rests 0.015 to 0.02 apart
    EXPECT_LE(rest - coasting, 0.0205) << gap;
  }
}

TEST(Box2dSimulator, RestingGapsInSettledClustersAreTheSkin) {
  const Box2dSimulator simulator(robot_and_box(), kPush, kPhysics);
  for (const double overlap : {-0.005, 0.0, 0.01, 0.1}) {
    const PushOutcome out = simulator.settle({{0, 0, 0}, {1.1 - overlap, 0, 0}});
    ASSERT_TRUE(out.ok);
    const double gap = out.end[1].x - out.end[0].x - 1.1;
    EXPECT_NEAR(gap, 0.015, 2e-4);
    EXPECT_NEAR(out.end[0].x, 0.0, 1e-3);  // the robot is held
    EXPECT_NEAR(simulator.settle(out.end).end[1].x, out.end[1].x, 1e-5);
  }
}

TEST(Box2dSimulator, TheForceBoundStopsARobotAtWhatItCannotMove) {
  Scene scene = robot_and_box();
  scene.bodies[1].fixed = true;
  const Poses start{{0, 0, 0}, {1.6, 0, 0}};
  const PushOutcome out = Box2dSimulator(scene, kPush, kPhysics).push(start, 0);
  ASSERT_TRUE(out.ok);
  EXPECT_EQ(out.end[1], start[1]);
  EXPECT_NEAR(out.end[1].x - out.end[0].x - 1.1, 0.015, 0.006);
  // The bound is force_factor times the robot's own drag: it moves a load of (force_factor - 1)
  // robots, no more.
  scene.bodies[1].fixed = false;
  const double ratio = mass_of(scene.bodies[0]).mass / mass_of(scene.bodies[1]).mass;
  scene.bodies[1].density = 0.9 * (kPhysics.force_factor - 1.0) * ratio;
  EXPECT_NEAR(Box2dSimulator(scene, kPush, kPhysics).push(start, 0).end[0].x, 2.0, 0.02);
  scene.bodies[1].density = 2.0 * (kPhysics.force_factor - 1.0) * ratio;
  EXPECT_LT(Box2dSimulator(scene, kPush, kPhysics).push(start, 0).end[0].x, 1.5);
}

TEST(Box2dSimulator, AnOffCentrePushTurnsTheBoxTheRightWay) {
  const Box2dSimulator simulator(robot_and_box(), kPush, kPhysics);
  const PushOutcome above = simulator.push({{0, 0.7, 0}, {1.3, 0, 0}}, 0);
  const PushOutcome below = simulator.push({{0, -0.7, 0}, {1.3, 0, 0}}, 0);
  ASSERT_TRUE(above.ok && below.ok);
  EXPECT_LT(above.end[1].theta, -0.2);
  EXPECT_NEAR(below.end[1].theta, -above.end[1].theta, 1e-2);  // mirror image
  EXPECT_NEAR(below.end[1].x, above.end[1].x, 1e-2);
}

TEST(Box2dSimulator, BadInputIsReportedAndNeverCrashes) {
  const tasks::Task task = gathering();
  const Box2dSimulator simulator = simulator_of(task);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e30, -1001.0}) {
    Poses start = task.start;
    start[2].y = bad;
    EXPECT_FALSE(simulator.push(start, 3).ok);
    EXPECT_FALSE(simulator.settle(start).ok);
    start = task.start;
    start[0].theta = 100.0 * bad;
    EXPECT_FALSE(simulator.push(start, 3).ok);
  }
  EXPECT_FALSE(simulator.push({}, 0).ok);
}

TEST(Box2dSimulator, DeepOverlapComesApartOrIsReported) {
  const tasks::Task task = gathering();
  const Box2dSimulator simulator = simulator_of(task);
  Rng rng(8);
  for (int k = 0; k < 100; ++k) {
    Poses start = task.start;
    for (Pose& pose : start) pose = {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-3, 3)};
    if (k == 0) start.assign(start.size(), Pose{});
    for (const PushOutcome& out : {simulator.push(start, k % 48), simulator.settle(start)})
      EXPECT_TRUE(is_finite(out.end));
    const PushOutcome rest = simulator.settle(start);
    EXPECT_TRUE(!rest.ok || !first_overlap(task.scene, rest.end, 0.0)) << k;
  }
}

// With Box2D's own timer the profile of such a step is a millisecond.
TEST(Box2dSimulator, StepsDoNotReadTheClock) {
  b2World world({0.0F, 0.0F});
  b2CircleShape disc;
  disc.m_radius = 1.0F;
  for (int k = 0; k < 400; ++k) {
    b2BodyDef body;
    body.type = b2_dynamicBody;
    body.position = {0.1F * static_cast<float>(k), 0.0F};
    world.CreateBody(&body)->CreateFixture(&disc, 1.0F);
  }
  world.Step(0.01F, 8, 3);
  EXPECT_EQ(world.GetProfile().step, 0.0F);
}

}  // namespace
}  // namespace rtg::forward
