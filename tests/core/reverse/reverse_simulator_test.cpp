#include "core/reverse/reverse_simulator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "core/forward/newton_simulator.hpp"
#include "tests/support/free_push.hpp"
#include "tests/support/random_push.hpp"

namespace rtg::reverse {
namespace {

const PhysicsConfig kPhysics;
const PushConfig kPush;

/// The hexagonal robot and `boxes` boxes.
Scene robot_and_boxes(int boxes) {
  Scene scene{{{"robot", "robot", regular_polygon(6, 0.8), 1.0, 0.5, false}}};
  for (int k = 0; k < boxes; ++k)
    scene.bodies.push_back({"box", "box", box(1.2, 1.2), 1.0, 0.5, false});
  return scene;
}

ReverseResult solve(const Scene& scene, const ReverseJob& job, const ReverseConfig& config = {}) {
  return ReverseSimulator(scene, kPhysics, kPush, config).solve(job);
}

/// A box in contact ahead of the robot, after a push to the right, and one out of reach.
ReverseJob touching_job() { return {{{0, 0, 0}, {1.41, 0.2, 0.05}, {-5, 5, 0.3}}, 0}; }

TEST(ReverseSimulator, AFreeRobotStepsBackOneStrideAndTheOthersStay) {
  const Poses end{{1, -2, 0.3}, {1, 5, 0.1}, {-5, -5, 0.2}};
  for (const int action : {0, 7, 30}) {
    const ReverseResult result = solve(robot_and_boxes(2), {end, action});
    ASSERT_EQ(result.status, SolveStatus::kConverged);
    const Vector2d back = end[0].position() - longest_stride(kPush) * direction(action, kPush);
    // The pull on the robot against the push and the price of control shift it a little.
    EXPECT_LT((result.predecessors[0][0].position() - back).norm(), 0.01);
    EXPECT_NEAR(result.predecessors[0][0].theta, 0.3, 1e-6);
    EXPECT_EQ(result.predecessors[0][1], end[1]);
    EXPECT_EQ(result.predecessors[0][2], end[2]);
    EXPECT_EQ(result.predecessors.size(), 1U);
  }
}

// Alone: the plain barrier has no end.
TEST(ReverseSimulator, WithThePapersPresetAFreeRobotFollowsTheClosedForm) {
  const Scene scene = robot_and_boxes(0);
  const ReverseConfig config = reverse_preset(ReversePreset::kPaper);
  const ReverseModel model = reverse_model(scene, kPhysics, config);
  const energy::StepEnergy energy(model.scene, model.physics, kPush);
  const Poses end{{1, -2, 0.3}};
  const ReverseResult result = solve(scene, {end, 5}, config);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  const Vector2d d = direction(5, kPush);
  const ReverseProblem problem{energy, config, energy::stacked(end), d, kPhysics.sub_steps};
  const double reach =
      kPhysics.sub_steps * energy.control_bound()[0] / mass_of(model.scene.bodies[0]).mass;
  const auto moved = [&](double along) {
    return reach * std::tanh(testing::closed_form_control(problem, along));
  };
  EXPECT_NEAR(result.predecessors[0][0].x, end[0].x - moved(d.x()), 1e-3);
  EXPECT_NEAR(result.predecessors[0][0].y, end[0].y - moved(d.y()), 1e-3);
}

// The first box is 6 m off the robot's way, the second one beyond.
TEST(ReverseSimulator, WithThePlainBarrierBodiesFarAwayAreMovedToo) {
  const Scene scene = robot_and_boxes(2);
  const ReverseJob job{{{0, 0, 0}, {0, 6, 0}, {1, 9, 0.5}}, 0};
  PhysicsConfig plain;
  plain.plain_barrier = true;
  const ReverseResult far = ReverseSimulator(scene, plain, kPush, {}).solve(job);
  ASSERT_EQ(far.status, SolveStatus::kConverged);
  const ReverseResult near = solve(scene, job);
  ASSERT_EQ(near.status, SolveStatus::kConverged);
  for (std::size_t k : {1U, 2U}) {
    EXPECT_GT((far.predecessors[0][k].position() - job.end[k].position()).norm(), 1e-3);
    EXPECT_EQ(near.predecessors[0][k], job.end[k]);
  }
}

// The skin is the gap at which bodies touch; forces reach beyond it by the range.
TEST(ReverseSimulator, ContactForcesReachByTheRangeBeyondTheSkin) {
  const ReverseJob job{{{0, 0, 0}, {1.41 + 0.25, 0.2, 0.05}}, 0};
  PhysicsConfig skinned;
  skinned.skin = 0.2;
  for (const auto& [physics, moved] : {std::pair(kPhysics, false), std::pair(skinned, true)}) {
    const ReverseResult result =
        ReverseSimulator(robot_and_boxes(1), physics, kPush, {}).solve(job);
    ASSERT_EQ(result.status, SolveStatus::kConverged);
    EXPECT_EQ(result.predecessors[0][1].x < job.end[1].x - 0.1, moved);
  }
}

// With the constants that eq. (6) leaves open as in the preset, the box that the robot touches goes
// back with it; with a weak barrier the robot lets go of it.
// Box2D lets bodies overlap by its slop, 5 mm.
TEST(ReverseSimulator, AnEndInWhichBodiesOverlapByBox2dsSlopHasAStart) {
  for (const double overlap : {0.0, 0.002, 0.005}) {
    const ReverseJob job{{{0, 0, 0}, {1.4 - overlap, 0, 0}}, 0};
    const ReverseResult result = solve(robot_and_boxes(1), job);
    ASSERT_EQ(result.status, SolveStatus::kConverged) << overlap;
    EXPECT_LT(result.predecessors[0][1].x, job.end[1].x - 1.0) << overlap;
  }
}

TEST(ReverseSimulator, ThePapersPresetDragsTheBoxThatTheRobotTouches) {
  ReverseConfig paper = reverse_preset(ReversePreset::kPaper);
  const ReverseJob job{{{0, 0, 0}, {1.46, 0.1, 0.0}}, 0};
  for (const auto& [barrier, dragged] : {std::pair(paper.plain_barrier, true), {0.02, false}}) {
    paper.plain_barrier = barrier;
    const ReverseResult result = solve(robot_and_boxes(1), job, paper);
    ASSERT_EQ(result.status, SolveStatus::kConverged) << barrier;
    EXPECT_LT(result.predecessors[0][0].x, -1.0);
    EXPECT_EQ(result.predecessors[0][1].x < job.end[1].x - 1.0, dragged) << barrier;
  }
}

TEST(ReverseSimulator, WithThePapersPresetThereIsNoStartAtTheIterationLimit) {
  ReverseConfig config = reverse_preset(ReversePreset::kPaper);
  config.max_iterations = 3;
  const ReverseResult result = solve(robot_and_boxes(1), {{{0, 0, 0}, {1.54, 0.1, 0}}, 0}, config);
  EXPECT_EQ(result.status, SolveStatus::kIterationLimit);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_TRUE(result.predecessors.empty());
}

// The pull on the robot against the push, 0.2 against a spring of 300, and what the contact
// resists.
TEST(ReverseSimulator, ASolutionThatMissesTheGivenEndIsNoneInEitherPreset) {
  ReverseConfig paper = reverse_preset(ReversePreset::kPaper);
  paper.terminal_weight = ReverseConfig().terminal_weight;
  const ReverseJob alone{{{0, 0, 0}}, 0};
  for (const auto& [config, boxes, job] :
       {std::tuple(paper, 0, alone), std::tuple(ReverseConfig(), 2, touching_job())}) {
    ReverseConfig strict = config, lax = config;
    strict.terminal_tolerance = 1e-4;
    lax.terminal_tolerance = 0.05;
    const Scene scene = robot_and_boxes(boxes);
    const ReverseResult missed = solve(scene, job, strict);
    EXPECT_EQ(missed.status, SolveStatus::kInfeasible);
    EXPECT_TRUE(missed.predecessors.empty());
    EXPECT_EQ(solve(scene, job, lax).status, SolveStatus::kConverged);
  }
}

/// Solves random scenes back after a push of the model, and pushes again from all starts found.
/// Returns how far the bodies then are from where they were, mean over the bodies [m], sorted.
std::vector<double> model_gaps(int scenes) {
  std::vector<double> gaps;
  for (int seed = 0; seed < scenes; ++seed) {
    const testing::RandomPush drawn = testing::random_push(seed, kPush);
    const forward::NewtonSimulator model(drawn.scene, kPush, kPhysics);
    const Poses end = model.push(drawn.start, drawn.action).end;
    const ReverseResult result = solve(drawn.scene, {end, drawn.action});
    for (const Poses& start : result.predecessors) {
      const Poses reached = model.push(start, drawn.action).end;
      double sum = 0.0;
      for (std::size_t k = 0; k < end.size(); ++k)
        sum += (reached[k].position() - end[k].position()).norm();
      gaps.push_back(sum / static_cast<double>(end.size()));
    }
  }
  std::ranges::sort(gaps);
  return gaps;
}

// The push is the straight one of the action; the solver's own controls differ from it a little.
TEST(ReverseSimulator, APushFromAnyOfTheStartsLeadsToTheEnd) {
  const std::vector<double> gaps = model_gaps(20);
  ASSERT_GE(gaps.size(), 32U);
  EXPECT_LT(gaps[gaps.size() / 2], 0.03);
  EXPECT_LT(gaps[gaps.size() * 8 / 10], 0.1);
}

// The box weighs 7 times as much as the robot, whose force is enough for 0.76 of its speed. At
// full speed it would be dragged by 0.3 m. Paces are exact to 0.05, so ends to 0.1 m.
TEST(ReverseSimulator, APushFromAnyStartBeforeAHeavyBoxLeadsToTheEnd) {
  Scene scene = robot_and_boxes(1);
  scene.bodies[1].density = 8.0;
  const forward::NewtonSimulator model(scene, kPush, kPhysics);
  for (const double turn : {0.0, 0.3}) {
    const Poses end = model.push({{-1.5, 0, 0}, {0, 0.1, turn}}, 0).end;
    const ReverseResult result = solve(scene, {end, 0});
    ASSERT_EQ(result.predecessors.size(), 8U);
    EXPECT_LT(result.predecessors[0][1].x, end[1].x - 1.3);
    for (const Poses& start : result.predecessors) {
      const Poses reached = model.push(start, 0).end;
      for (const std::size_t k : {0U, 1U})
        EXPECT_LT((reached[k].position() - end[k].position()).norm(), 0.15) << start[1].x;
    }
  }
}

// The robot passes the heavy box and pushes the light one.
TEST(ReverseSimulator, AHeavyBoxThatThePushDoesNotMoveDoesNotSlowIt) {
  Scene scene = robot_and_boxes(2);
  const ReverseJob job{{{0, 0, 0}, {1.41, 0.2, 0.05}, {-1.0, 1.43, 0}}, 0};
  const ReverseResult light = solve(scene, job);
  scene.bodies[2].density = 8.0;
  const ReverseResult heavy = solve(scene, job);
  EXPECT_LT(
      (heavy.predecessors.at(0)[1].position() - light.predecessors.at(0)[1].position()).norm(),
      0.01);
  EXPECT_GT(heavy.iterations, light.iterations) << "nothing was solved again";
}

// The robot begins where it does for the whole push, the objects part of the way.
TEST(ReverseSimulator, LateContactsStandBetweenTheStartOfTheWholePushAndTheEnd) {
  const ReverseJob job = touching_job();
  ReverseConfig config;
  config.late_contacts = 4;
  const ReverseResult result = solve(robot_and_boxes(2), job, config);
  ASSERT_EQ(result.predecessors.size(), 5U);
  for (std::size_t k = 1; k < 5; ++k) {
    const Poses &start = result.predecessors[k], &before = result.predecessors[k - 1];
    EXPECT_EQ(start[0], before[0]);
    EXPECT_GT(start[1].x, before[1].x + 0.2);  // a fifth of the stride is 0.4 m
    EXPECT_LT(start[1].x, job.end[1].x - 0.2);
    EXPECT_EQ(start[2], job.end[2]);
  }
}

TEST(ReverseSimulator, ThereAreNoMoreStartsThanSubSteps) {
  ReverseConfig config;
  config.late_contacts = 30;
  const ReverseResult result = solve(robot_and_boxes(2), touching_job(), config);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  const auto& starts = result.predecessors;
  EXPECT_EQ(static_cast<int>(starts.size()), kPhysics.sub_steps + kPhysics.settling_steps());
  for (std::size_t k = 1; k < starts.size(); ++k) EXPECT_GT(starts[k][1].x, starts[k - 1][1].x);
}

// The robot has turned a bar that is pinned at its centre; nothing else moves.
TEST(ReverseSimulator, ATurnAloneHasLateContactsToo) {
  Scene scene = robot_and_boxes(0);
  scene.bodies.push_back({"post", "post", box(0.2, 0.2), 1.0, 0.5, true});
  scene.bodies.push_back({"bar", "bar", box(4.0, 0.6), 1.0, 0.5, false});
  scene.joints.push_back({1, 2, {0.0, 0.0}, {0.0, 0.0}});
  const Poses start{{-1.5, -1.5, 0}, {0, 0, 0}, {0, 0, 0}};
  const Poses end = forward::NewtonSimulator(scene, kPush, kPhysics).push(start, 12).end;
  ASSERT_LT(end[2].theta, -0.3);
  const ReverseResult result = solve(scene, {end, 12});
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT((result.predecessors[0][2].position() - end[2].position()).norm(), 1e-6);
  EXPECT_GT(result.predecessors.size(), 1U);
}

// A job's stride is its own, whatever the strides of others in the lanes beside it.
TEST(ReverseSimulator, EachStrideIsPulledBackAsIfItWereTheOnlyOne) {
  const PushConfig both{48, {1.0, 2.0}, 8.0};
  const ReverseSimulator together(robot_and_boxes(2), kPhysics, both, {});
  std::vector<ReverseJob> jobs;
  for (int action = 0; action < action_count(both); action += 3)
    jobs.push_back({touching_job().end, action});
  const std::vector<ReverseResult> results = together.solve(jobs);
  int dragged = 0;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    const PushConfig one = with_stride_of(jobs[k].action, both);
    const ReverseResult alone = ReverseSimulator(robot_and_boxes(2), kPhysics, one, {})
                                    .solve({jobs[k].end, jobs[k].action % both.headings});
    EXPECT_EQ(results[k].status, alone.status) << k;
    EXPECT_EQ(results[k].predecessors, alone.predecessors) << k;
    if (alone.status != SolveStatus::kConverged) continue;
    const Poses& start = results[k].predecessors[0];
    EXPECT_NEAR((start[0].position() - jobs[k].end[0].position()).norm(),
                stride_of(jobs[k].action, both), 0.2);
    dragged += (start[1].position() - jobs[k].end[1].position()).norm() > 0.2;
  }
  EXPECT_GE(dragged, 4);
}

TEST(ReverseSimulator, PrunedJobsComeBackUnsolved) {
  ReverseJob job = touching_job();
  job.action = 24;  // away from the box, out of it
  const ReverseResult result = solve(robot_and_boxes(2), job);
  EXPECT_EQ(result.status, SolveStatus::kPruned);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_TRUE(result.predecessors.empty());
}

TEST(ReverseSimulator, BadEndsAreNotFiniteAndHaveNoStart) {
  const Scene scene = robot_and_boxes(2);
  std::vector<ReverseJob> bad(4, touching_job());
  bad[0].end.pop_back();
  bad[1].end.clear();
  bad[2].end[0].theta = std::nan("");
  bad[3].end[2].x = std::numeric_limits<double>::infinity();
  for (const ReverseJob& job : bad) {
    const ReverseResult result = solve(scene, job);
    EXPECT_EQ(result.status, SolveStatus::kNonFinite);
    EXPECT_TRUE(result.predecessors.empty());
  }
}

// Twelve of the 48 headings are a quarter turn; the bounds of the controls hold per axis, so other
// turns are another problem.
TEST(ReverseSimulator, TheSceneMayStandElsewhereAndByAQuarterTurn) {
  const Scene scene = robot_and_boxes(2);
  const ReverseJob job = touching_job();
  const ReverseResult here = solve(scene, job);
  ASSERT_EQ(here.status, SolveStatus::kConverged);
  const auto moved = [](const Pose& p) {
    return Pose{2.0 - p.y, -1.0 + p.x, p.theta + std::numbers::pi / 2.0};
  };
  ReverseJob there{{}, 12};
  for (const Pose& p : job.end) there.end.push_back(moved(p));
  const ReverseResult result = solve(scene, there);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  for (std::size_t k = 0; k < job.end.size(); ++k) {
    const Pose expected = moved(here.predecessors[0][k]);
    EXPECT_LT((result.predecessors[0][k].position() - expected.position()).norm(), 1e-5);
    EXPECT_NEAR(result.predecessors[0][k].theta, expected.theta, 1e-5);
  }
}

TEST(ReverseSimulator, FixedBodiesMayStandAnywhereInTheOrder) {
  Scene last = robot_and_boxes(3), first = last;
  last.bodies[3].fixed = first.bodies[1].fixed = true;
  const Pose wall{1.5, -1.12, 0.0};  // beside the box, in the barrier's range
  const ReverseResult a = solve(last, {{{0, 0, 0}, {1.41, 0.2, 0}, {-5, 5, 0}, wall}, 0});
  const ReverseResult b = solve(first, {{{0, 0, 0}, wall, {1.41, 0.2, 0}, {-5, 5, 0}}, 0});
  ASSERT_EQ(a.status, SolveStatus::kConverged);
  EXPECT_EQ(b.status, a.status);
  EXPECT_EQ(b.iterations, a.iterations);
  const Poses &p = a.predecessors[0], &q = b.predecessors[0];
  EXPECT_EQ(q, (Poses{p[0], p[3], p[1], p[2]}));
  EXPECT_EQ(p[3], wall);
}

// The push from the start that it has then ends near the given state.
TEST(ReverseSimulator, AtTheIterationLimitAStartIsAcceptableIfThePushReachesTheEnd) {
  ReverseConfig config;
  config.max_iterations = 3;
  for (const auto& [tolerance, status] :
       {std::pair(config.terminal_tolerance, SolveStatus::kAcceptable),
        {1e-4, SolveStatus::kIterationLimit}}) {
    config.terminal_tolerance = tolerance;
    const ReverseResult result = solve(robot_and_boxes(2), touching_job(), config);
    EXPECT_EQ(result.status, status);
    EXPECT_EQ(result.iterations, 3);
    EXPECT_EQ(!result.predecessors.empty(), status == SolveStatus::kAcceptable);
  }
}

TEST(ReverseSimulator, AnAcceptableStartReplaysInTheModel) {
  ReverseConfig config;
  config.max_iterations = 3;
  const Scene scene = robot_and_boxes(2);
  const ReverseJob job = touching_job();
  const ReverseResult result = solve(scene, job, config);
  ASSERT_EQ(result.status, SolveStatus::kAcceptable);
  const forward::NewtonSimulator model(scene, kPush, kPhysics);
  const Poses reached = model.push(result.predecessors[0], job.action).end;
  for (std::size_t k = 0; k < job.end.size(); ++k)
    EXPECT_LT((reached[k].position() - job.end[k].position()).norm(), config.terminal_tolerance);
}

TEST(ReverseSimulator, AnswersAnyLayoutWithFiniteStarts) {
  const Scene scene = robot_and_boxes(2);
  Rng rng(61);
  for (int trial = 0; trial < 30; ++trial) {
    ReverseJob job{Poses(3), rng.below(48)};  // many of them overlap
    for (Pose& p : job.end) p = {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-9, 9)};
    const ReverseResult result = solve(scene, job);
    ASSERT_EQ(!result.predecessors.empty(), result.status == SolveStatus::kConverged);
    for (const Poses& start : result.predecessors) {
      ASSERT_EQ(start.size(), 3U);
      ASSERT_TRUE(is_finite(start));
    }
  }
}

/// Returns the sum of the contact forces on `body` at the end of a sub-step [N].
Vector2d contact_force(const ReverseSolution& solution, int body, int sub_step) {
  Vector2d sum = Vector2d::Zero();
  for (const ContactForce& c : solution.contacts) {
    if (c.sub_step != sub_step) continue;
    if (c.body == body) sum += c.force * c.normal;
    if (c.other == body) sum -= c.force * c.normal;
  }
  return sum;
}

TEST(ReverseSimulator, ASolutionIsThereIfItIsAskedForAndBeginsAtThePredecessor) {
  ReverseJob job = touching_job();
  const ReverseSimulator simulator(robot_and_boxes(2), kPhysics, kPush, {});
  const ReverseResult plain = simulator.solve(job);
  EXPECT_FALSE(plain.solution.has_value());
  job.with_solution = true;
  const ReverseResult result = simulator.solve(job);
  EXPECT_EQ(result.predecessors, plain.predecessors);
  ASSERT_TRUE(result.solution.has_value());
  const ReverseSolution& s = *result.solution;
  ASSERT_EQ(s.trajectory.size(), static_cast<std::size_t>(kPhysics.sub_steps) + 1);
  ASSERT_EQ(s.controls.size(), static_cast<std::size_t>(kPhysics.sub_steps));
  EXPECT_EQ(s.trajectory[0], result.predecessors[0]);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT((s.trajectory.back()[k].position() - job.end[k].position()).norm(), 0.05);
  for (const Poses& poses : s.trajectory) EXPECT_EQ(poses[2], job.end[2]) << "out of reach";
  EXPECT_LT(s.infeasibility, ReverseConfig{}.feasibility_tol);
  EXPECT_LT(s.stationarity, ReverseConfig{}.stationarity_tol);
  EXPECT_NE(s.objective, 0.0);
}

// k_D/Δt² m Δx = F, eq. (8): without inertia the force moves the box. The robot touches one of its
// faces, so that friction acts along this and the normal force alone across it.
TEST(ReverseSimulator, TheContactForcesOfASolutionMoveTheBox) {
  ReverseJob job = touching_job();
  job.with_solution = true;
  const Scene scene = robot_and_boxes(2);
  const ReverseResult result = ReverseSimulator(scene, kPhysics, kPush, {}).solve(job);
  ASSERT_TRUE(result.solution.has_value());
  const ReverseSolution& s = *result.solution;
  const double drag = kPhysics.damping * mass_of(scene.bodies[1]).mass /
                      (kPhysics.time_step * kPhysics.time_step);  // [N/m]
  int pushed = 0;
  for (int k = 1; k <= kPhysics.sub_steps; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const Vector2d moved = s.trajectory[at][1].position() - s.trajectory[at - 1][1].position();
    const Vector2d force = contact_force(s, 1, k);
    if (moved.norm() < 0.05) continue;
    ++pushed;
    EXPECT_NEAR(force.norm(), drag * moved.dot(force.normalized()), 0.02 * force.norm()) << k;
  }
  EXPECT_GT(pushed, kPhysics.sub_steps / 2);
  for (const ContactForce& c : s.contacts) {
    EXPECT_NEAR(c.normal.norm(), 1.0, 1e-12);
    EXPECT_TRUE((c.body == 1 && c.other == 0) || (c.body == 0 && c.other == 1));
    const Poses& poses = s.trajectory[static_cast<std::size_t>(c.sub_step)];
    const double to_box = to_local(poses[1], c.point).lpNorm<Eigen::Infinity>() - 0.6;
    EXPECT_LT(std::abs(to_box), 0.15 + 1e-9) << "on the surface, or within the range of it";
  }
}

TEST(ReverseSimulator, APrunedPushHasNoSolution) {
  const ReverseJob job{{{0, 0, 0}, {-1.41, 0.0, 0.0}}, 0, true};
  const ReverseResult result = solve(robot_and_boxes(1), job);
  EXPECT_EQ(result.status, SolveStatus::kPruned);
  EXPECT_FALSE(result.solution.has_value());
}

}  // namespace
}  // namespace rtg::reverse
