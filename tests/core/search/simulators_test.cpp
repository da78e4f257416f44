#include "core/search/simulators.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/forward/box2d_simulator.hpp"
#include "core/forward/newton_simulator.hpp"
#include "core/reverse/naive_reverse.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::search {
namespace {

using testing::gathering;

/// Gathering after a push to the right: the robot touches a box, which touches the next.
Poses touching(const tasks::Task& task) {
  const Poses row{{-2, 0, 0}, {-0.5, 0.1, 0.05}, {0.85, 0.2, 0.3}, {2, 4, 0}};
  return forward_replay(task, {})({row, 0}).end;
}

/// Returns what a node of the beam asks for: a job per heading.
std::vector<reverse::ReverseJob> layer(const tasks::Task& task) {
  std::vector<reverse::ReverseJob> jobs;
  for (int action = 0; action < task.push.headings; ++action)
    jobs.push_back({touching(task), action});
  return jobs;
}

// Enough of them that threads solve different slices of it together.
TEST(Simulators, ALayerOfReverseSolvesHasTheSameBitsOn1To16Threads) {
  tasks::Task task = gathering();
  task.push.headings = 14;
  std::vector<reverse::ReverseJob> jobs;
  for (int node = 0; node < 2; ++node)
    for (reverse::ReverseJob job : layer(task)) {
      job.end[1].y += 0.02 * node;
      jobs.push_back(std::move(job));
    }
  const SolveBatch solve = reverse_solver(task, {}, {}, Generator::kRrbs);
  const std::vector<reverse::ReverseResult> reference = solve_on_threads(solve, 1)(jobs);
  const auto iterations =
      std::ranges::max(reference, {}, &reverse::ReverseResult::iterations).iterations;
  ASSERT_GT(iterations, 10);  // solves in contact are among them
  for (const int threads : {2, 16}) {
    const std::vector<reverse::ReverseResult> results = solve_on_threads(solve, threads)(jobs);
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      ASSERT_EQ(results[k].status, reference[k].status);
      ASSERT_EQ(results[k].iterations, reference[k].iterations);
      ASSERT_EQ(results[k].predecessors, reference[k].predecessors);
    }
  }
}

TEST(Simulators, ReplayIsBox2dsPushAndItsSettling) {
  const tasks::Task task = gathering();
  const forward::Box2dSimulator box2d(task.scene, task.push, {});
  const ReplayOne replay = forward_replay(task, {});
  Poses close = task.start;
  close[0] = {-3.0, -0.3, 0.0};  // overlaps a box a little
  EXPECT_EQ(replay({close, 12}).end, box2d.push(close, 12).end);
  EXPECT_EQ(replay({close, kSettle}).end, box2d.settle(close).end);
  EXPECT_NE(replay({close, kSettle}).end, replay({close, 12}).end);
  EXPECT_TRUE(replay({close, kSettle}).ok);
  EXPECT_FALSE(replay({{}, kSettle}).ok);
}

// After the push the box touches the robot; the two models differ in the gap that is left.
TEST(Simulators, ReplayIsThePushOfTheEngineAskedFor) {
  const tasks::Task task = gathering();
  const forward::NewtonSimulator newton(task.scene, task.push, {});
  const ReplayOne replay = forward_replay(task, {}, {std::string(forward::kNewton)});
  Poses start = task.start;
  start[0] = {-3.0, -1.0, 0.0};
  constexpr int kUp = 12;
  EXPECT_EQ(replay({start, kUp}).end, newton.push(start, kUp).end);
  EXPECT_EQ(replay({start, kSettle}).end, newton.settle(start).end);
  const Poses other = forward_replay(task, {})({start, kUp}).end;
  ASSERT_GT(other[1].y, start[1].y + 1.0);
  EXPECT_NE(replay({start, kUp}).end, other);
  EXPECT_NEAR(replay({start, kUp}).end[1].y, other[1].y, 0.05);
}

TEST(Simulators, NaiveGeneratorIsTheNaiveReverse) {
  const tasks::Task task = gathering();
  const SolveBatch solve = reverse_solver(task, {}, {}, Generator::kNaive);
  const reverse::NaiveReverse naive(task.scene, task.push);
  const std::vector<reverse::ReverseJob> jobs = layer(task);
  const std::vector<reverse::ReverseResult> results = solve(jobs);
  ASSERT_EQ(results.size(), jobs.size());
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    EXPECT_EQ(results[k].status, naive.solve(jobs[k]).status);
    EXPECT_EQ(results[k].predecessors, naive.solve(jobs[k]).predecessors);
  }
}

}  // namespace
}  // namespace rtg::search
