// FilterSqp in dynamic mode.

#include <gtest/gtest.h>

#include "core/forward/newton_simulator.hpp"
#include "core/reverse/reverse_simulator.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/random_push.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::CoastingScene;
using testing::expect_the_same_solution;
using testing::replayed;
using testing::solved;

/// The touching scene's robot and box after a push in which it met the box, which coasted on. With
/// k_D = 1 that is another 0.2 m.
struct AfterAPush {
  CoastingScene scene;
  ReverseConfig config;
  ReverseProblem problem = scene.problem(config);

  AfterAPush() {
    const forward::PushOutcome out =
        forward::NewtonSimulator(scene.scene, scene.task.push, scene.physics)
            .push({{-2, 0, 0}, {-0.2, 0.02, 0}, {0, 40, 0}}, 0);
    EXPECT_TRUE(out.ok);
    problem.end = energy::stacked(out.end);
    config.feasibility_tol = 1e-9;
  }
};

TEST(FilterSqpInertia, ACoastingBoxIsTakenBackToWhereItWasPushed) {
  const AfterAPush at;
  ASSERT_GT(at.problem.end[3] - at.problem.end[0], 1.4 + 0.15);  // out of the barrier's range
  const SqpResult result = solved(at.problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT(terminal_miss(at.problem, result.x), 0.01);
  EXPECT_LT(result.x.p[0][3] - at.problem.end[3], -1.9);
  EXPECT_LT((result.x.p[0] - at.problem.end).tail(3).norm(), 0.01);
}

TEST(FilterSqpInertia, ForwardOfReverseWithTheSolversControlsIsTheEnd) {
  const AfterAPush at;
  const SqpResult result = solved(at.problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  const std::vector<VectorXd> p = replayed(at.problem, result.x).p;
  for (std::size_t k = 0; k < p.size(); ++k) EXPECT_LT((p[k] - result.x.p[k]).norm(), 1e-6) << k;
}

// p_{-1} = p_0, and at the end p_h = p_{h-1} but for the hundredth of the push speed that settling
// leaves and what the springs do not hold.
TEST(FilterSqpInertia, PushesLeadFromRestToRest) {
  const AfterAPush at;
  const SqpResult result = solved(at.problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  const std::size_t h = result.x.p.size() - 1;
  EXPECT_LT((result.x.p[h] - result.x.p[h - 1]).norm(), 0.02 * at.scene.energy.stride());
  EXPECT_GT((result.x.p[h - 7] - result.x.p[h - 8]).norm(), 0.2 * at.scene.energy.stride());
}

// Without friction a sub-step is explicit backwards:
//   p₋ = 2 p - p₊ - k_D (p₊ - p) - k_D M⁻¹ (∂P_⊥(p₊) - F).
TEST(FilterSqpInertia, WithoutFrictionSubStepsAreExplicitBackwards) {
  AfterAPush at;
  for (Body& body : at.scene.scene.bodies) body.friction = 0.0;
  at.scene.physics.damping = 0.7;
  at.scene.update();
  const SqpResult result = solved(at.problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  for (std::size_t k = 2; k < result.x.p.size(); ++k) {
    const VectorXd &next = result.x.p[k], &now = result.x.p[k - 1];
    VectorXd force = at.scene.energy.model(next, {next, VectorXd::Zero(28), &next}).gradient;
    const Vector3d push = result.x.controls[k].array().tanh();
    force.head<3>() -= at.scene.energy.control_bound().cwiseProduct(push);
    for (int i = 0; i < 3; ++i) {
      const energy::Damping<double>& body = at.scene.energy.damping(i);
      const Vector3d mass(body.mass, body.mass, body.moment);
      const auto part = [i](const VectorXd& p) { return Vector3d(p.segment<3>(3 * i)); };
      const Vector3d before = 2.0 * part(now) - part(next) - 0.7 * (part(next) - part(now)) -
                              0.7 * part(force).cwiseQuotient(mass);
      EXPECT_LT((before - part(result.x.p[k - 2])).norm(), 1e-6);
    }
  }
}

TEST(FilterSqpInertia, EveryKktMethodGivesTheSameSolution) {
  AfterAPush at;
  expect_the_same_solution(at.problem, at.config,
                           {KktMethod::kCyclicReduction, KktMethod::kUmfpack, KktMethod::kKlu});
}

// Their Hessian couples the poses of three sub-steps.
TEST(FilterSqpInertia, EveryKktMethodGivesTheSameSolutionWithPeriodicTurns) {
  AfterAPush at;
  at.scene.physics.periodic_turns = true;
  at.scene.update();
  expect_the_same_solution(at.problem, at.config,
                           {KktMethod::kCyclicReduction, KktMethod::kUmfpack, KktMethod::kKlu});
}

// The box has come to rest in the final state but for a hundredth of its speed, which damping
// divides by 1 + k_D per sub-step.
TEST(FilterSqpInertia, AFixedFinalStateIsReachedExactly) {
  AfterAPush at;
  at.config.terminal_weight = 0.0;
  const SqpResult result = solved(at.problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_EQ(result.x.p.back(), at.problem.end);
  EXPECT_LT(violation(at.problem, result.x).max(), 1e-9);
  EXPECT_LT(result.x.p[0][0] - at.problem.end[0], -1.0);
  const std::size_t h = result.x.p.size() - 1;
  const double last = (result.x.p[h] - result.x.p[h - 1]).norm();
  const double last_but_one = (result.x.p[h - 1] - result.x.p[h - 2]).norm();
  EXPECT_LT(last, 0.01 * at.scene.energy.stride());
  EXPECT_NEAR(last_but_one / last, 1.0 + at.scene.physics.damping, 1e-3);
}

TEST(FilterSqpInertia, PushesOfRandomScenesAreFoundBack) {
  PhysicsConfig physics;
  physics.inertia = true;
  physics.damping = 1.0;
  physics.barrier *= 2.0 / 21.0;  // as the forces, which grow with 1 + k_D
  const PushConfig push;
  int converged = 0, moved = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const testing::RandomPush drawn = testing::random_push(seed, push);
    const forward::PushOutcome end =
        forward::NewtonSimulator(drawn.scene, push, physics).push(drawn.start, drawn.action);
    ASSERT_TRUE(end.ok);
    const ReverseResult result =
        ReverseSimulator(drawn.scene, physics, push, {}).solve({end.end, drawn.action});
    if (result.status != SolveStatus::kConverged) continue;
    ++converged;
    EXPECT_EQ(result.predecessors.size(), 1u);
    for (std::size_t i = 1; i < end.end.size(); ++i)
      if ((result.predecessors[0][i].position() - end.end[i].position()).norm() > 0.5) {
        ++moved;
        break;
      }
  }
  EXPECT_GE(converged, 27);
  EXPECT_GE(moved, 16);  // 3 if mirroring begins where the robot stopped
}

}  // namespace
}  // namespace rtg::reverse
