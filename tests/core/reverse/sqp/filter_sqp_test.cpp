#include "core/reverse/sqp/filter_sqp.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "core/forward/newton_simulator.hpp"
#include "tests/support/free_push.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/random_push.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::expect_the_same_solution;
using testing::noise;
using testing::replayed;
using testing::solved;
using testing::solved_from;
using testing::TouchingScene;

TEST(FilterSqp, ReverseOfAFreePushIsTheClosedForm) {
  const TouchingScene scene;
  ReverseConfig config = testing::free_push_config({});
  config.feasibility_tol = 1e-11;
  config.stationarity_tol = 1e-10;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{1, 2, 0.3}, {40, 0, 0}, {0, 40, 0}});
  problem.direction = {0.6, 0.8};
  const SqpResult result = solved_from(problem, static_iterate(problem));
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  testing::expect_closed_form(problem, result.x, 1e-6);
  EXPECT_LT((result.x.p[0] - problem.end).tail(6).norm(), 1e-15);
}

// The gap carries the box's drag at push speed, so the push dragged it along.
TEST(FilterSqp, ATouchedBoxIsDraggedTheWholeStrideBack) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {1.4087, 0, 0}, {40, 0, 0}});
  const SqpResult result = solved(problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_NEAR(result.x.p[0][3] - problem.end[3], -2.0, 0.05);
  EXPECT_NEAR(result.x.p[0][0], -2.0, 0.02);
  EXPECT_LT(terminal_miss(problem, result.x), 0.01);
}

TEST(FilterSqp, ForwardOfReverseWithTheSolversControlsIsTheEnd) {
  const TouchingScene scene;
  ReverseConfig config;
  config.feasibility_tol = 1e-10;
  const ReverseProblem problem = scene.problem(config);
  const SqpResult result = solved(problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT((replayed(problem, result.x).p.back() - result.x.p.back()).norm(), 1e-6);
  EXPECT_LT(terminal_miss(problem, result.x), config.terminal_tolerance);
}

// With the final state fixed instead of held by a spring, and one that a push leads to, the end is
// the given one. Which problems the solver does not solve, or solves by a saddle of Ψ (as below),
// hangs on rounding; most it does.
TEST(FilterSqp, ForwardOfReverseIsTheGivenStateWhereItIsFixed) {
  ReverseConfig config;
  config.terminal_weight = 0.0;
  config.feasibility_tol = 1e-9;
  Rng rng(5);
  int posed = 0, converged = 0, held = 0;
  for (int trial = 0; trial < 24; ++trial) {
    TouchingScene scene;
    for (std::size_t i = 1; i < scene.poses.size(); ++i) {
      scene.poses[i].y += rng.uniform(-0.1, 0.1);
      scene.poses[i].theta += rng.uniform(-0.1, 0.1);
    }
    ReverseProblem problem = scene.problem(config);
    const std::optional<Iterate> pushed = warm_start(problem);
    if (!pushed) continue;
    ++posed;
    problem.end = pushed->p.back();
    const SqpResult result = solved_from(problem, static_iterate(problem));
    if (result.status != SolveStatus::kConverged) continue;
    ++converged;
    EXPECT_EQ(result.x.p.back(), problem.end);
    held += (replayed(problem, result.x).p.back() - problem.end).norm() < 1e-6;
  }
  EXPECT_GE(posed, 10);
  EXPECT_GE(converged, 8);
  EXPECT_GE(held, 5);
}

/// A random scene after a push of the model.
struct PushedScene {
  PushConfig push;
  testing::RandomPush drawn;
  energy::StepEnergy energy{drawn.scene, {}, push};

  explicit PushedScene(std::uint64_t seed) : drawn(testing::random_push(seed, push)) {}
  ReverseProblem problem(const ReverseConfig& config) const {
    const forward::PushOutcome end =
        forward::NewtonSimulator(drawn.scene, push, {}).push(drawn.start, drawn.action);
    return {energy, config, energy::stacked(end.end), direction(drawn.action, push), 10};
  }
};

// A constraint met to 1e-9 leaves an error of 1e-9/g in a normal force, 1e-7 at the least gaps. Not
// all solutions come out: (7) asks for stationary sub-steps, and where bodies meet at corners, the
// objective may find a saddle of Ψ, or a minimum that a simulation from the state before it misses.
TEST(FilterSqp, ForwardOfReverseIsTheEndInMostRandomScenes) {
  ReverseConfig config;
  config.feasibility_tol = 1e-9;
  int converged = 0, held = 0;
  for (std::uint64_t seed = 100; seed < 112; ++seed) {
    const PushedScene scene(seed);
    const ReverseProblem problem = scene.problem(config);
    const SqpResult result = solved(problem);
    if (result.status != SolveStatus::kConverged) continue;
    ++converged;
    held += (replayed(problem, result.x).p.back() - result.x.p.back()).norm() < 1e-6;
  }
  EXPECT_GE(converged, 9);
  EXPECT_GE(held, 6);
}

// Without friction a sub-step is explicit backwards: p = p₊ + M⁻¹ (∂P_⊥(p₊) - F).
TEST(FilterSqp, WithoutFrictionSubStepsAreExplicitBackwards) {
  TouchingScene scene;
  for (Body& body : scene.scene.bodies) body.friction = 0.0;
  scene.energy = energy::StepEnergy(scene.scene, scene.physics, scene.task.push);
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const SqpResult result = solved(problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  for (std::size_t k = 1; k < result.x.p.size(); ++k) {
    const VectorXd& next = result.x.p[k];
    VectorXd force = scene.energy.model(next, {next, VectorXd::Zero(28)}).gradient;  // ∂P_⊥
    const Vector3d push = result.x.controls[k].array().tanh();
    force.head<3>() -= scene.energy.control_bound().cwiseProduct(push);
    for (int i = 0; i < 3; ++i) {
      const energy::Damping<double>& body = scene.energy.damping(i);
      const Vector3d mass(body.mass, body.mass, body.moment);
      EXPECT_LT((next.segment<3>(3 * i) + force.segment<3>(3 * i).cwiseQuotient(mass) -
                 result.x.p[k - 1].segment<3>(3 * i))
                    .norm(),
                1e-4);  // 1e-6 of Φ over λ's own 1e-6/g
    }
  }
}

// Every forward simulation is feasible, so none near the solution may have a lower objective.
TEST(FilterSqp, NoForwardSimulationNearbyIsBetter) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const SqpResult result = solved(problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  const double least = objective(problem, result.x);
  Rng rng(1);
  for (int trial = 0; trial < 30; ++trial) {
    Iterate other = result.x;
    other.p[0] += noise(9, 2e-3, rng);
    for (Vector3d& c : other.controls) c += noise(3, 2e-3, rng);
    EXPECT_GT(objective(problem, replayed(problem, other)), least);
  }
}

TEST(FilterSqp, EveryKktMethodGivesTheSameSolution) {
  const TouchingScene scene;
  ReverseConfig config;
  expect_the_same_solution(scene.problem(config), config,
                           {KktMethod::kCyclicReduction, KktMethod::kUmfpack, KktMethod::kKlu});
}

// One in which nothing moves is feasible, too.
TEST(FilterSqp, WithAFixedEndAFeasibleIterateIsNoSolution) {
  const TouchingScene scene;
  ReverseConfig config;
  config.stationarity_tol = 1e-300;  // is never met
  config.terminal_tolerance = 0.1;
  for (const double spring : {1.0, 0.0}) {
    config.terminal_weight = spring * ReverseConfig{}.terminal_weight;
    const SqpResult result = solved(scene.problem(config));
    EXPECT_LT(result.infeasibility, config.feasibility_tol);
    EXPECT_EQ(result.status == SolveStatus::kAcceptable, spring > 0.0);
  }
}

TEST(FilterSqp, StopsAtTheIterationLimit) {
  const TouchingScene scene;
  ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  for (const int limit : {0, 1, 3}) {
    config.max_iterations = limit;
    const SqpResult result = solved(problem);
    EXPECT_EQ(result.status, SolveStatus::kIterationLimit);
    EXPECT_EQ(result.iterations, limit);
  }
}

TEST(FilterSqp, SolutionsMeetTheirTolerances) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  const SqpResult result = solved(problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT(violation(problem, result.x).max(), config.feasibility_tol);
  EXPECT_LT(terminal_miss(problem, result.x), config.terminal_tolerance);
  EXPECT_NEAR(result.infeasibility, violation(problem, result.x).max(), 1e-15);
}

// The warm start alone ends elsewhere.
TEST(FilterSqp, WhereTheFinalStateIsFixedTheSolutionEndsInIt) {
  const TouchingScene scene;
  ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {1.41, 0.2, 0.05}, {20, 0, 0}});
  config.terminal_weight = 0.0;
  ASSERT_GT(terminal_miss(problem, *warm_start(problem)), 1e-4);
  const SqpResult result = solved(problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_EQ(result.x.p.back(), problem.end);
  EXPECT_LT(violation(problem, result.x).max(), config.feasibility_tol);
}

TEST(FilterSqp, AnOverlappingEndIsInfeasible) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}});
  const SqpResult result = solved(problem);
  EXPECT_EQ(result.status, SolveStatus::kInfeasible);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.x.p[0], problem.end);
}

TEST(FilterSqp, ReportsWhatIsNotFinite) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config);
  Iterate start = static_iterate(problem);
  start.controls[3][1] = NAN;
  EXPECT_EQ(solved_from(problem, start).status, SolveStatus::kNonFinite);
}

// The barrier of overlapping bodies is infinite.
TEST(FilterSqp, ReportsAStartThatIsNoLegalIterate) {
  const TouchingScene scene;
  const ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  problem.end = energy::stacked({{0, 0, 0}, {40, 0, 0}, {40.9, 0.2, 0}});
  const SqpResult result = solved_from(problem, static_iterate(problem));
  EXPECT_EQ(result.status, SolveStatus::kNonFinite);
}

/// Reports every system as singular.
class NeverRegular final : public StageSolver<double> {
 public:
  bool solve(const StageSystem<double>&, StageStep<double>&) override { return false; }
};

// Ten systems are solved with pivoting, all others are rejected until no δ helps. Then feasibility
// is restored, and ten more are enough.
TEST(FilterSqp, SolvesSingularSystemsWithPivotingAndGoesOnAfterARestoration) {
  const TouchingScene scene;
  const ReverseConfig config;
  const ReverseProblem problem = scene.problem(config), *one = &problem;
  const Iterate start = static_iterate(problem);
  const SqpResult regular = solved_from(problem, start);
  ASSERT_GT(regular.iterations, 10);
  const SqpResult result =
      FilterSqp<double>(problem, std::make_unique<NeverRegular>()).solve({&one, 1}, {&start, 1})[0];
  EXPECT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_GT(result.iterations, regular.iterations + 10);
  for (std::size_t k = 0; k < result.x.p.size(); ++k)
    EXPECT_LT((result.x.p[k] - regular.x.p[k]).norm(), 1e-4);
}

TEST(FilterSqp, DoesNotSolveASingularSystemTwiceByKlu) {
  const TouchingScene scene;
  ReverseConfig config;
  config.kkt = KktMethod::kKlu;
  const ReverseProblem problem = scene.problem(config), *one = &problem;
  const Iterate start = static_iterate(problem);
  const SqpResult result =
      FilterSqp<double>(problem, std::make_unique<NeverRegular>()).solve({&one, 1}, {&start, 1})[0];
  EXPECT_NE(result.status, SolveStatus::kConverged);
}

}  // namespace
}  // namespace rtg::reverse
