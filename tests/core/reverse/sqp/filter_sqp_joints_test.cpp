// FilterSqp on jointed bodies.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/energy/open_gaps.hpp"
#include "core/forward/box2d_simulator.hpp"
#include "core/reverse/reverse_simulator.hpp"
#include "core/world/separation.hpp"
#include "tests/support/chain_scene.hpp"
#include "tests/support/one_candidate.hpp"

namespace rtg::reverse {
namespace {

using testing::replayed;
using testing::robot_and_chain;
using testing::solved;
using testing::widest_joint;

/// States after pushes of Box2D at a chain of four links, with the action that led there.
std::vector<ReverseJob> pushed_chains(const Scene& scene, const PushConfig& push,
                                      const PhysicsConfig& physics) {
  const forward::Box2dSimulator box2d(scene, push, physics);
  Rng rng(1);
  std::vector<ReverseJob> jobs;
  Poses state =
      with_closed_joints(scene, {{0, -4, 0}, {-3.6, 0, 0}, {0, 0, 0.3}, {0, 0, -0.2}, {0, 0, 0.1}});
  while (jobs.size() < 24) {
    const Vector2d way = state[1 + rng.below(4)].position() - state[0].position();
    const double turns = std::atan2(way.y(), way.x()) / 6.2832 + 1.0;
    const int action = static_cast<int>(48.0 * turns + rng.uniform(-3.0, 3.0)) % 48;
    const forward::PushOutcome out = box2d.push(state, action);
    if ((out.end[2].position() - state[2].position()).norm() > 0.1)
      jobs.push_back({out.end, action});
    state = out.end;
  }
  return jobs;
}

/// The reverse problem of one of those pushes.
struct PushedChain {
  Scene scene = robot_and_chain();
  PushConfig push;
  PhysicsConfig physics;
  ReverseConfig config;
  energy::StepEnergy energy{scene, physics, push};
  ReverseJob job;
  ReverseProblem problem;

  explicit PushedChain(std::size_t which = 0)
      : job(pushed_chains(scene, push, physics)[which]),
        problem{energy, config, with_open_gaps(energy, energy::stacked(job.end)),
                direction(job.action, push), physics.sub_steps} {}
};

TEST(FilterSqpJoints, ForwardOfReverseWithTheSolversControlsIsTheEnd) {
  PushedChain chain;
  chain.config.feasibility_tol = 1e-9;
  const SqpResult result = solved(chain.problem);
  ASSERT_EQ(result.status, SolveStatus::kConverged);
  EXPECT_LT(terminal_miss(chain.problem, result.x), chain.config.terminal_tolerance);
  EXPECT_GT((result.x.p[0] - chain.problem.end).segment<2>(6).norm(), 0.5);  // it was dragged
  for (std::size_t k = 1; k < result.x.p.size(); ++k)
    EXPECT_LT(widest_joint(chain.scene, energy::unstacked(result.x.p[k])), 1e-14);
  const VectorXd p = replayed(chain.problem, result.x).p.back();
  EXPECT_LT((p - result.x.p.back()).norm(), 1e-6);
}

// Where a problem has several minima, rounding may decide between them.
TEST(FilterSqpJoints, MostlyEveryKktMethodGivesTheSameSolution) {
  int same = 0;
  for (std::size_t which = 0; which < 8; ++which) {
    PushedChain chain(which);
    std::vector<VectorXd> starts;
    for (const KktMethod method : {KktMethod::kBlockElimination, KktMethod::kCyclicReduction,
                                   KktMethod::kUmfpack, KktMethod::kKlu}) {
      chain.config.kkt = method;
      starts.push_back(solved(chain.problem).x.p[0]);
    }
    same += std::ranges::all_of(
        starts, [&](const VectorXd& start) { return (start - starts[0]).norm() < 1e-5; });
  }
  EXPECT_GE(same, 6);
}

double mean_gap(const Poses& a, const Poses& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i].position() - b[i].position()).norm();
  return sum / static_cast<double>(a.size());
}

TEST(FilterSqpJoints, PushesOfAChainAreFoundBackAndReplay) {
  const Scene scene = robot_and_chain();
  const PushConfig push;
  const PhysicsConfig physics;
  const forward::Box2dSimulator box2d(scene, push, physics);
  const std::vector<ReverseJob> jobs = pushed_chains(scene, push, physics);
  const std::vector<ReverseResult> results = ReverseSimulator(scene, physics, push, {}).solve(jobs);
  int solved = 0, converged = 0, dragged = 0, replayed = 0;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    ASSERT_NE(results[k].status, SolveStatus::kPruned) << k;
    ++solved;
    if (results[k].status != SolveStatus::kConverged) continue;
    ++converged;
    const Poses &start = results[k].predecessors[0], &end = jobs[k].end;
    EXPECT_LT(widest_joint(scene, start), 1e-14);
    if ((start[2].position() - end[2].position()).norm() < 0.1) continue;
    ++dragged;
    replayed += mean_gap(box2d.push(start, jobs[k].action).end, end) < 0.15;
  }
  EXPECT_EQ(solved, 24);
  EXPECT_GE(10 * converged, 9 * solved);
  EXPECT_GE(10 * dragged, 8 * converged);
  EXPECT_GE(10 * replayed, 8 * dragged);
}

/// A robot and a heavy rail that lies loose, with a carriage on it that carries a plate.
Scene robot_and_rail() {
  Scene scene{{testing::gathering().scene.bodies[0],
               {"rail", "rail", box(2.4, 0.7), 5.0, 0.5, false},
               {"carriage", "carriage", box(0.8, 0.8), 1.0, 0.5, false},
               {"plate", "plate", box(0.8, 0.4), 1.0, 0.5, false}}};
  Joint slides{1, 2, {0.0, 0.8}, {0.0, 0.0}, -1.0, 1.0, JointType::kPrismatic};
  Joint fixed{2, 3, {0.0, 0.6}, {0.0, 0.0}};
  fixed.type = JointType::kFixed;
  scene.joints = {slides, fixed};
  return scene;
}

TEST(FilterSqpJoints, PushesOfACarriageAreFoundBackAndReplay) {
  const Scene scene = robot_and_rail();
  const PushConfig push;
  const forward::Box2dSimulator box2d(scene, push, {});
  Rng rng(1);
  std::vector<ReverseJob> jobs;
  for (int tries = 0; jobs.size() < 24 && tries < 500; ++tries) {
    Poses state{{0, 0, 0}, {0, 0, rng.uniform(-3.0, 3.0)}, {0, 0, 0}, {0, 0, 0}};
    set_joint_value(scene.joints[0], rng.uniform(-0.9, 0.9), state);
    set_joint_value(scene.joints[1], 0.0, state);
    const Vector2d at = state[2].position() + rotate(rng.uniform(-3.2, 3.2), {2.5, 0.0});
    state[0] = {at.x(), at.y(), 0.0};
    if (first_overlap(scene, state)) continue;
    const Vector2d way = state[2].position() - at;
    const double turns = std::atan2(way.y(), way.x()) / 6.2832 + 1.0;
    const int action = static_cast<int>(48.0 * turns + rng.uniform(-3.0, 3.0)) % 48;
    const forward::PushOutcome out = box2d.push(state, action);
    const double slid = joint_value(scene.joints[0], out.end) - joint_value(scene.joints[0], state);
    if (std::abs(slid) > 0.1) jobs.push_back({with_closed_joints(scene, out.end), action});
  }
  ASSERT_EQ(jobs.size(), 24u);
  const std::vector<ReverseResult> results = ReverseSimulator(scene, {}, push, {}).solve(jobs);
  int converged = 0, slid = 0, replayed = 0;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (results[k].status != SolveStatus::kConverged) continue;
    ++converged;
    const Poses &start = results[k].predecessors[0], &end = jobs[k].end;
    EXPECT_LT(widest_joint(scene, start), 1e-14);
    const double value = joint_value(scene.joints[0], end);
    if (std::abs(joint_value(scene.joints[0], start) - value) < 0.05) continue;
    ++slid;
    replayed += mean_gap(box2d.push(start, jobs[k].action).end, end) < 0.15;
  }
  EXPECT_GE(10 * converged, 8 * 24);
  EXPECT_GE(2 * slid, converged);
  EXPECT_GE(10 * replayed, 7 * slid);
}

// Candidates of the same joints are solved in lanes, a robot alone beside them.
TEST(FilterSqpJoints, LanesFindWhatEachFindsAlone) {
  const Scene scene = robot_and_chain();
  const ReverseSimulator simulator(scene, {}, {}, {});
  std::vector<ReverseJob> jobs = pushed_chains(scene, {}, {});
  jobs.resize(9);
  jobs.push_back(jobs[0]);
  jobs.back().end[0] = {-6.0, -6.0, 0.0};
  const std::vector<ReverseResult> together = simulator.solve(jobs);
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    const ReverseResult alone = simulator.solve(jobs[k]);
    EXPECT_EQ(together[k].status, alone.status);
    EXPECT_EQ(together[k].iterations, alone.iterations);
    EXPECT_EQ(together[k].predecessors, alone.predecessors);
  }
}

}  // namespace
}  // namespace rtg::reverse
