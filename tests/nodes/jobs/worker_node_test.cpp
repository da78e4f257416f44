#include "nodes/jobs/worker_node.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <stdexcept>

#include "nodes/program/serve.hpp"

namespace rtg::jobs {
namespace {

using namespace std::chrono_literals;
using rtg_msgs::reverse_job_t;
using rtg_msgs::reverse_result_t;
using rtg_msgs::worker_beat_t;

constexpr TaskShape kShape{.bodies = 2, .actions = 48};
constexpr std::int64_t kConfig = 77;

const std::vector<reverse::ReverseJob> kJobs{{{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, 5},
                                             {{{1.5, 2.0, 3.0}, {4.0, 5.0, 6.0}}, 47}};

reverse::ReverseResult solved(const reverse::ReverseJob& job) {
  Poses start = job.end;
  start[0].x -= 1.0;
  return {reverse::SolveStatus::kConverged, job.action, {start}, 0.25};
}

std::vector<reverse::ReverseResult> solve(std::span<const reverse::ReverseJob> jobs) {
  std::vector<reverse::ReverseResult> out;
  for (const reverse::ReverseJob& job : jobs) out.push_back(solved(job));
  return out;
}

/// Holds a worker and notes, on the same bus, what it says.
class Pair {
 public:
  explicit Pair(WorkerNode<ReverseService>::Answer answer = solve)
      : worker(bus, {kShape, kConfig, 3, 1}, std::move(answer)) {
    bus.subscribe<worker_beat_t>("RTG_REVERSE_BEAT",
                                 [this](const worker_beat_t& m) { beats.push_back(m); });
    bus.subscribe<reverse_result_t>("RTG_REVERSE_RESULT",
                                    [this](const reverse_result_t& m) { results.push_back(m); });
  }

  reverse_job_t job(std::int64_t id) const {
    reverse_job_t message = ReverseService::message(kJobs);
    message.job_id = id;
    message.to = worker.incarnation();
    return message;
  }

  void send(const reverse_job_t& message) { bus.publish("RTG_REVERSE_JOB", message); }

  /// Serves the bus until `done`.
  template <class Done>
  void serve_until(const Done& done) {
    while (!done()) {
      bus.spin(5ms);
      worker.tick(bus::monotonic_now());
    }
  }

  bus::Bus bus{"memq://", bus::RunKey::random("test")};
  std::vector<worker_beat_t> beats;
  std::vector<reverse_result_t> results;
  WorkerNode<ReverseService> worker;
};

TEST(WorkerNode, AnswersAsTheDirectCallDoes) {
  Pair pair;
  pair.send(pair.job(11));
  pair.serve_until([&] { return !pair.results.empty(); });
  EXPECT_EQ(pair.results[0].job_id, 11);
  EXPECT_EQ(pair.results[0].incarnation, pair.worker.incarnation());
  const auto results = ReverseService::parse(pair.results[0], kShape);
  ASSERT_TRUE(results && results->size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ((*results)[k].predecessors, solved(kJobs[k]).predecessors);
    EXPECT_EQ((*results)[k].iterations, kJobs[k].action);
  }
}

TEST(WorkerNode, SaysWhoItIsAndWhatItHolds) {
  std::mutex gate;
  std::unique_lock closed(gate);
  Pair pair([&](std::span<const reverse::ReverseJob> jobs) {
    const std::scoped_lock wait(gate);
    return solve(jobs);
  });
  pair.send(pair.job(11));
  pair.send(pair.job(12));
  pair.serve_until([&] { return !pair.beats.empty() && pair.beats.back().n_held == 2; });
  EXPECT_EQ(pair.beats.back().held, (std::vector<std::int64_t>{11, 12}));
  EXPECT_EQ(pair.beats.back().config, kConfig);
  EXPECT_EQ(pair.beats.back().worker, 3);
  EXPECT_EQ(pair.beats.back().capacity, 3);
  closed.unlock();
  pair.serve_until([&] { return pair.beats.back().n_held == 0; });
  EXPECT_EQ(pair.results.size(), 2U);
}

TEST(WorkerNode, AnswersARepeatedQuestionFromMemory) {
  std::atomic<int> calls = 0;
  Pair pair([&](std::span<const reverse::ReverseJob> jobs) { return ++calls, solve(jobs); });
  pair.send(pair.job(11));
  pair.serve_until([&] { return !pair.beats.empty() && pair.results.size() == 1; });
  pair.serve_until([&] { return pair.beats.back().n_held == 0; });
  pair.send(pair.job(11));
  pair.serve_until([&] { return pair.results.size() >= 2; });  // in several copies
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(pair.results[1].start, pair.results[0].start);
  EXPECT_EQ(pair.bus.counters().value("jobs.answered_again"), 1);
}

TEST(WorkerNode, CountsAndIgnoresWhatItCannotUse) {
  Pair pair;
  reverse_job_t out_of_range = pair.job(1), other_bodies = pair.job(2), nothing{};
  out_of_range.action[1] = 48;
  other_bodies.end.resize(6);
  other_bodies.n_poses = 6;
  nothing.to = pair.worker.incarnation();
  for (const auto& message : {out_of_range, other_bodies, nothing}) pair.send(message);
  reverse_job_t someone_elses = pair.job(4);
  ++someone_elses.to;
  pair.send(someone_elses);
  pair.send(pair.job(5));
  pair.serve_until([&] { return !pair.results.empty(); });
  EXPECT_EQ(pair.results[0].job_id, 5);
  EXPECT_EQ(pair.bus.counters().value("jobs.illegal"), 3);
}

TEST(WorkerNode, WhatTheSolverThrowsSurfacesInTick) {
  Pair pair([](std::span<const reverse::ReverseJob>) -> std::vector<reverse::ReverseResult> {
    throw std::range_error("boom");
  });
  pair.send(pair.job(11));
  EXPECT_THROW(pair.serve_until([] { return false; }), std::range_error);
}

TEST(WorkerNode, IsStuckOnceAUnitHasBeenInWorkForLongerThanAnyTakes) {
  std::mutex gate;
  std::unique_lock closed(gate);
  Pair pair([&](std::span<const reverse::ReverseJob> jobs) {
    const std::scoped_lock wait(gate);
    return solve(jobs);
  });
  const bus::Seconds lease = JobDispatcher::Limits{}.lease;
  EXPECT_FALSE(pair.worker.stuck(bus::monotonic_now() + lease + 1.0));  // with nothing
  pair.send(pair.job(11));
  pair.serve_until([&] { return pair.worker.stuck(bus::monotonic_now() + lease + 1.0); });
  EXPECT_FALSE(pair.worker.stuck(bus::monotonic_now() + lease - 100.0));
  closed.unlock();
  pair.serve_until([&] { return !pair.results.empty() && pair.beats.back().n_held == 0; });
  EXPECT_FALSE(pair.worker.stuck(bus::monotonic_now() + lease + 1.0));
}

TEST(WorkerNodeDeathTest, AProcessThatIsStuckEndsThoughItsThreadDoesNot) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto hang =
      [](std::span<const reverse::ReverseJob>) -> std::vector<reverse::ReverseResult> {
    std::promise<void>().get_future().wait();
    return {};
  };
  const auto process = [&] {
    bus::Bus bus("memq://", bus::RunKey::random("test"));
    WorkerNode<ReverseService> worker(bus, {kShape, kConfig, 3, 1, 0.0}, hang);
    reverse_job_t message = ReverseService::message(kJobs);
    message.to = worker.incarnation();
    bus.publish("RTG_REVERSE_JOB", message);
    std::exit(program::serve(bus, worker));
  };
  EXPECT_EXIT(process(), ::testing::ExitedWithCode(1), "stuck: a unit of work takes longer");
}

TEST(WorkerNode, HearsThatTheCoordinatorLeavesOrIsGone) {
  Pair pair;
  EXPECT_FALSE(pair.worker.coordinator().leaving());
  EXPECT_FALSE(pair.worker.coordinator().silent(bus::monotonic_now()));
  EXPECT_TRUE(
      pair.worker.coordinator().silent(bus::monotonic_now() + bus::CoordinatorWatch::kSilence + 1));
  rtg_msgs::search_progress_t progress{};
  pair.bus.publish("RTG_PROGRESS", progress);
  progress.leaving = 1;
  pair.bus.publish("RTG_PROGRESS", progress);
  pair.serve_until([&] { return pair.worker.coordinator().leaving(); });
}

}  // namespace
}  // namespace rtg::jobs
