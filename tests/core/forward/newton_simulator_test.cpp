#include "core/forward/newton_simulator.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "core/energy/implicit_step.hpp"
#include "core/forward/box2d_simulator.hpp"
#include "core/math/rng.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/random_push.hpp"

namespace rtg::forward {
namespace {

using testing::random_push;
using testing::RandomPush;

const PhysicsConfig kPhysics;
const PushConfig kPush;

/// The hexagonal robot, a vertex ahead, and a box on its left and right.
Scene robot_and_boxes() {
  return {{{"robot", "robot", regular_polygon(6, 0.8), 1.0, 0.5, false},
           {"box", "box", box(1.2, 1.2), 1.0, 0.5, false},
           {"box", "box", box(1.2, 1.2), 1.0, 0.5, false}}};
}

NewtonSimulator simulator() { return {robot_and_boxes(), kPush, kPhysics}; }

/// Returns how far the servo lags behind where it pulls with share·B: e = s artanh(share).
double servo_lag(double share) {
  return energy::servo_scale(longest_stride(kPush) / kPhysics.sub_steps) * std::atanh(share);
}

/// Returns where a free push by `action` ends: at push speed the drag along d(a) is B/force_factor,
/// and each coordinate has a servo of its own.
Vector2d end_of_free_push(const Pose& start, int action) {
  const Vector2d end = push_target(start, stroke_of(action, kPush), kPush).position();
  const Vector2d share = direction(action, kPush) / kPhysics.force_factor;
  return end - Vector2d(servo_lag(share.x()), servo_lag(share.y()));
}

TEST(NewtonSimulator, AFreePushEndsAtTheTargetLessTheServosLag) {
  const Poses start{{1, -2, 0.3}, {1, 5, 0}, {-5, -5, 0}};
  for (const int action : {0, 7, 24, 41}) {
    const PushOutcome out = simulator().push(start, action);
    ASSERT_TRUE(out.ok);
    EXPECT_LT((out.end[0].position() - end_of_free_push(start[0], action)).norm(), 1e-8);
    EXPECT_NEAR(out.end[0].theta, 0.3, 1e-9);
    EXPECT_EQ(out.end[1], start[1]);
    EXPECT_EQ(out.end[2], start[2]);
  }
}

TEST(NewtonSimulator, AFreePushEndsWhereBox2dsDoes) {
  const Poses start{{1, -2, 0.3}, {1, 5, 0}, {-5, -5, 0}};
  const Box2dSimulator box2d(robot_and_boxes(), kPush, kPhysics);
  for (const int action : {0, 5, 30}) {
    const Vector2d newton = simulator().push(start, action).end[0].position();
    const Vector2d other = box2d.push(start, action).end[0].position();
    const Vector2d lag = push_target(start[0], stroke_of(action, kPush), kPush).position() -
                         end_of_free_push(start[0], action);
    EXPECT_LT((newton + lag - other).norm(), 1e-5);
    EXPECT_LT(lag.norm(), 2e-3);
  }
}

TEST(NewtonSimulator, EachStrideIsPushedAsIfItWereTheOnlyOne) {
  const Scene scene = testing::gathering().scene;
  const Poses start = testing::gathering().start;
  const PushConfig both{48, {0.7, 2.0}, 8.0};
  for (int action = 0; action < action_count(both); action += 7) {
    const PushConfig one = with_stride_of(action, both);
    for (const bool box2d : {false, true}) {
      const auto push = [&](const PushConfig& config, int a) {
        return box2d ? Box2dSimulator(scene, config, kPhysics).push(start, a)
                     : NewtonSimulator(scene, config, kPhysics).push(start, a);
      };
      EXPECT_EQ(push(both, action).end, push(one, action % 48).end) << action;
    }
  }
}

TEST(NewtonSimulator, TheRobotStaysInTheArena) {
  const Poses start{{7, 7, 0.3}, {1, 5, 0}, {-5, -5, 0}};
  const PushOutcome out = simulator().push(start, 0);
  ASSERT_TRUE(out.ok);
  EXPECT_NEAR(out.end[0].x, kPush.arena, servo_lag(0.5 / kPhysics.force_factor) + 1e-8);
}

/// The gap at which the barrier's force is `force`, by bisection.
double resting_gap(const energy::Barrier& barrier, double force) {
  double low = 1e-9, high = barrier.range;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (barrier.force(middle) > force ? low : high) = middle;
  }
  return low;
}

// In steady pushing by a vertex the contact carries the box's drag, λ(g) = m_b · stride/h, and the
// servo that of both. Without inertia nothing coasts.
TEST(NewtonSimulator, APushedBoxEndsWhereItsDragBalancesTheBarrier) {
  const Scene scene = robot_and_boxes();
  const energy::StepEnergy energy(scene, kPhysics, kPush);
  const double robot = mass_of(scene.bodies[0]).mass, box = mass_of(scene.bodies[1]).mass;
  const double gap = resting_gap(energy.barrier(), box * energy.stride());
  const PushOutcome out = simulator().push({{0, 0, 0}, {1.7, 0, 0}, {-5, -5, 0}}, 0);
  ASSERT_TRUE(out.ok);
  const double share = (robot + box) / robot / kPhysics.force_factor;
  EXPECT_NEAR(out.end[0].x, longest_stride(kPush) - servo_lag(share), 1e-6);
  EXPECT_NEAR(out.end[1].x - out.end[0].x, 0.8 + 0.6 + gap, 1e-6);
  EXPECT_NEAR(out.end[1].y, 0.0, 1e-9);
  EXPECT_NEAR(out.end[1].theta, 0.0, 1e-9);
}

// Box2D's box keeps its speed v for a moment and coasts by v Δt/k_D, and its skin is another one.
TEST(NewtonSimulator, APushedBoxEndsWhereBox2dsDoesButForSkinAndCoasting) {
  const Poses start{{0, 0, 0}, {1.7, 0, 0}, {-5, -5, 0}};
  const Box2dSimulator box2d(robot_and_boxes(), kPush, kPhysics);
  const double speed = longest_stride(kPush) / (kPhysics.sub_steps * kPhysics.time_step);
  const double coasting = speed * kPhysics.time_step / kPhysics.damping, skin = 0.02;
  const double ahead = box2d.push(start, 0).end[1].x - simulator().push(start, 0).end[1].x;
  EXPECT_GT(ahead, 0.0);
  EXPECT_LT(ahead, coasting + skin);
}

TEST(NewtonSimulator, AFixedBodyStopsTheRobotAndStays) {
  Scene scene = robot_and_boxes();
  std::swap(scene.bodies[1], scene.bodies[2]);
  scene.bodies[1].fixed = true;  // before a movable one, which the simulator puts in order
  const Poses start{{0, 0, 0}, {1.7, 0, 0}, {0, 5, 0.1}};
  const PushOutcome out = NewtonSimulator(scene, kPush, kPhysics).push(start, 0);
  ASSERT_TRUE(out.ok);
  EXPECT_EQ(out.end[1], start[1]);
  EXPECT_EQ(out.end[2], start[2]);
  EXPECT_GT(out.end[0].x, 0.28);
  EXPECT_LT(out.end[0].x, 0.3);
}

// A box within the barrier's range creeps away until the barrier lets go of it; the robot is held.
TEST(NewtonSimulator, SettlingHoldsTheRobotAndOpensContacts) {
  const Poses start{{0, 0, 0}, {1.41, 0, 0}, {-5, -5, 0}};
  const PushOutcome out = simulator().settle(start);
  ASSERT_TRUE(out.ok);
  EXPECT_NEAR(out.end[0].x, 0.0, 1e-3);
  EXPECT_GT(out.end[1].x, 1.43);
  EXPECT_LT(out.end[1].x, 1.4 + kPhysics.range);
  EXPECT_EQ(out.end[2], start[2]);
}

TEST(NewtonSimulator, OverlapByBox2dsSlopIsNoObstacle) {
  const PushOutcome out = simulator().push({{0, 0, 0}, {1.396, 0, 0}, {-5, -5, 0}}, 0);
  ASSERT_TRUE(out.ok);
  EXPECT_GT(out.end[1].x, 3.39);
}

TEST(NewtonSimulator, EqualPushesGiveEqualBitsOnAnyThread) {
  constexpr std::size_t kPushes = 12;
  std::vector<Poses> alone, mixed(kPushes);
  const auto push = [](std::size_t seed) {
    const RandomPush drawn = random_push(seed, kPush);
    return NewtonSimulator(drawn.scene, kPush, kPhysics).push(drawn.start, drawn.action).end;
  };
  for (std::size_t k = 0; k < kPushes; ++k) alone.push_back(push(k));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t k = kPushes; k-- > 0;)
        if (k % 4 == t) mixed[k] = push(k);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(alone, mixed);
}

TEST(NewtonSimulator, NoTwoBodiesOverlapAfterRandomPushes) {
  const double corners = 2.0 * std::log(2.0) / kPhysics.sharpness;  // that smoothing cuts
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RandomPush drawn = random_push(seed, kPush);
    const PushOutcome out =
        NewtonSimulator(drawn.scene, kPush, kPhysics).push(drawn.start, drawn.action);
    ASSERT_TRUE(out.ok) << seed;
    EXPECT_FALSE(first_overlap(drawn.scene, out.end, -corners)) << seed;
  }
}

TEST(NewtonSimulator, BadInputIsReportedAndComesBackUnchanged) {
  const Poses start{{0, 0, 0}, {1.7, 0, 0}, {-5, -5, 0}};
  EXPECT_FALSE(simulator().push({}, 0).ok);
  EXPECT_FALSE(simulator().settle({{0, 0, 0}}).ok);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Poses broken = start;
    broken[1].theta = bad;
    EXPECT_FALSE(simulator().push(broken, 3).ok);
    EXPECT_FALSE(simulator().settle(broken).ok);
  }
  Poses overlapping = start;
  overlapping[1] = overlapping[0];
  const PushOutcome out = simulator().push(overlapping, 0);
  EXPECT_FALSE(out.ok);
  EXPECT_EQ(out.end, overlapping);
}

}  // namespace
}  // namespace rtg::forward
