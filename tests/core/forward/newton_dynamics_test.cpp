// NewtonSimulator in dynamic mode.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/energy/implicit_step.hpp"
#include "core/forward/box2d_simulator.hpp"
#include "core/forward/newton_simulator.hpp"
#include "tests/support/random_push.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::forward {
namespace {

using testing::CoastingScene;
using testing::TouchingScene;

/// Takes one sub-step after the other without any force, from `now` moved by `by` in the sub-step
/// before.
std::vector<VectorXd> coasted(const energy::StepEnergy& energy, VectorXd now, const VectorXd& by,
                              int sub_steps) {
  VectorXd before = now - by;
  std::vector<VectorXd> all{now};
  for (int k = 0; k < sub_steps; ++k) {
    const auto step = implicit_step(energy, {now, energy.forces(now), &before},
                                    energy::Drive<double>::controls(Vector3d::Zero()));
    EXPECT_TRUE(step);
    before = std::exchange(now, step->next);
    all.push_back(now);
  }
  return all;
}

VectorXd scattered() { return energy::stacked({{0, 0, 0.4}, {5, 0, 0.1}, {0, 5, 0.2}}); }

// The way of a sub-step falls by 1 + k_D in each, for both forms of small turns: after n of them a
// body has coasted (1 - (1 + k_D)^-n)/k_D of its last way.
TEST(NewtonDynamics, AFreeBodyCoastsByTheGeometricSeries) {
  for (const double k_D : {0.1, 0.5, 3.0}) {
    CoastingScene scene;
    scene.physics.damping = k_D;
    scene.update();
    VectorXd by = VectorXd::Zero(9);
    by.segment<3>(3) << 0.1, -0.05, 0.02;
    constexpr int kSubSteps = 30;
    const std::vector<VectorXd> p = coasted(scene.energy, scattered(), by, kSubSteps);
    for (int n = 0; n <= kSubSteps; ++n) {
      const double share = (1.0 - std::pow(1.0 + k_D, -n)) / k_D;
      EXPECT_LT((p[static_cast<std::size_t>(n)] - scattered() - share * by).norm(), 1e-8);
    }
  }
}

// Σ m Δt falls by 1 + k_D per sub-step, whatever the contacts do.
TEST(NewtonDynamics, MomentumChangesByDampingAlone) {
  const CoastingScene scene;  // k_D = 1
  VectorXd by = VectorXd::Zero(9);
  by.segment<3>(0) << 0.15, 0.02, 0.0;
  const std::vector<VectorXd> p = coasted(scene.energy, energy::stacked(scene.poses), by, 8);
  EXPECT_GT(p.back()[6] - p.front()[6], 0.02);  // the collisions reached the last body
  Vector2d last = scene.energy.damping(0).mass * by.head<2>();
  for (std::size_t n = 1; n < p.size(); ++n) {
    Vector2d momentum = Vector2d::Zero();
    for (int i = 0; i < 3; ++i)
      momentum += scene.energy.damping(i).mass * (p[n] - p[n - 1]).segment<2>(3 * i);
    EXPECT_LT((momentum - 0.5 * last).norm(), 1e-8);
    last = momentum;
  }
}

// A push that meets nothing until its last sub-step leaves a body at rest and the robot at its
// target; all else would be at rest from the start.
TEST(NewtonDynamics, AFreePushEndsAtTheTargetAtRest) {
  const CoastingScene scene;
  const NewtonSimulator simulator(scene.scene, scene.task.push, scene.physics);
  const PushOutcome out = simulator.push({{1, -2, 0.3}, {1, 5, 0}, {-5, -5, 0}}, 0);
  ASSERT_TRUE(out.ok);
  EXPECT_NEAR(out.end[0].x, 3.0, 1e-3);
  EXPECT_NEAR(out.end[0].y, -2.0, 1e-6);
  EXPECT_EQ(out.end[1], (Pose{1, 5, 0}));
}

// Box2D with a step per sub-step damps as Ψ does, v/(1 + k_D). What differs is the contact: the
// barrier's range and Box2D's skin.
TEST(NewtonDynamics, APushedBoxCoastsAsBox2dsDoes) {
  for (const double k_D : {0.1, 0.5, 2.0}) {
    CoastingScene scene;
    scene.physics.damping = k_D;
    scene.physics.sub_steps = 40;
    scene.physics.box2d_steps = 1;
    scene.physics.barrier = 0.5 * (1.0 + k_D);
    scene.physics.time_step = 0.0125;
    scene.physics.range = 0.05;
    const Poses start{{0, 0, 0}, {1.7, 0, 0}, {-5, -5, 0}};
    const PushOutcome newton =
        NewtonSimulator(scene.scene, scene.task.push, scene.physics).push(start, 0);
    const PushOutcome box2d =
        Box2dSimulator(scene.scene, scene.task.push, scene.physics).push(start, 0);
    ASSERT_TRUE(newton.ok && box2d.ok);
    const double coasted = box2d.end[1].x - box2d.end[0].x - 1.4;
    EXPECT_NEAR(coasted, 0.05 / k_D, 0.02 + 0.1 * 0.05 / k_D);  // a stride of 0.05 m over k_D
    EXPECT_NEAR(newton.end[1].x, box2d.end[1].x, 0.02 + 0.03 * coasted) << k_D;
    EXPECT_NEAR(newton.end[1].theta, box2d.end[1].theta, 1e-3);
  }
}

double median_difference(const PhysicsConfig& physics) {
  const PushConfig push;
  std::vector<double> differences;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const testing::RandomPush drawn = testing::random_push(seed, push);
    const Poses a = NewtonSimulator(drawn.scene, push, physics).push(drawn.start, drawn.action).end;
    const Poses b = Box2dSimulator(drawn.scene, push, physics).push(drawn.start, drawn.action).end;
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i].position() - b[i].position()).norm();
    differences.push_back(sum / static_cast<double>(a.size()));
  }
  std::ranges::sort(differences);
  return differences[differences.size() / 2];
}

// Where bodies coast by a fifth of a stride the quasi-static model misses that.
TEST(NewtonDynamics, WithLittleDampingItIsNearerToBox2dThanQuasiStaticSteps) {
  PhysicsConfig physics;
  physics.damping = 0.5;
  physics.barrier *= 1.5 / 21.0;  // as the forces, which grow with 1 + k_D
  const double still = median_difference(physics);
  physics.inertia = true;
  const double dynamic = median_difference(physics);
  EXPECT_LT(dynamic, 0.05);
  EXPECT_LT(2.0 * dynamic, still);
}

TEST(NewtonDynamics, QuasiStaticStepsDoNotDependOnTheMotionBefore) {
  const TouchingScene scene;
  const VectorXd now = energy::stacked(scene.poses), previous_forces = scene.energy.forces(now);
  const VectorXd before = now - VectorXd::Constant(9, 0.1);
  const auto drive = energy::Drive<double>::towards({0.2, 0, 0});
  EXPECT_EQ(implicit_step(scene.energy, {now, previous_forces, &before}, drive)->next,
            implicit_step(scene.energy, {now, previous_forces}, drive)->next);
}

}  // namespace
}  // namespace rtg::forward
