#include "nodes/beam_coordinator/coordinator_node.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <list>
#include <rtg_msgs/search_progress_t.hpp>
#include <rtg_msgs/transition_batch_t.hpp>
#include <thread>

#include "core/search/simulators.hpp"
#include "nodes/beam_coordinator/row_digest.hpp"
#include "nodes/jobs/flat_poses.hpp"
#include "nodes/jobs/worker_node.hpp"
#include "tests/nodes/bus/handle_all.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/generation_run.hpp"

namespace rtg::beam_coordinator {
namespace {

using rtg_msgs::search_progress_t;
using rtg_msgs::transition_batch_t;
using testing::gathering;

constexpr std::int64_t kConfig = 77;
constexpr std::uint64_t kSeed = 7;

search::SearchConfig small() {
  search::SearchConfig config;
  config.generator = search::Generator::kNaive;
  config.transitions = 1200;
  config.breadth = 6;
  config.depth = 10;
  return config;
}

/// The whole process graph on one bus in one process.
class Graph {
 public:
  explicit Graph(
      int workers, std::function<bool()> stopped = [] { return false; })
      : coordinator(bus, {shape(), kConfig, small().transitions, std::move(stopped)}),
        server_(bus, {shape(), kConfig, 0, 2},
                search::replay_on_threads(search::forward_replay(task, {}), 1)) {
    bus.subscribe<transition_batch_t>("RTG_TRANSITION",
                                      [this](const transition_batch_t& m) { on_rows(m); });
    for (int k = 0; k < workers; ++k)
      workers_.emplace_back(
          bus, jobs::WorkerNode<jobs::ReverseService>::Options{shape(), kConfig, k, 1},
          search::solve_on_threads(reverse_solver(task, {}, {}, search::Generator::kNaive), 1));
  }

  std::optional<search::GenerationReport> run() {
    const std::jthread ticking([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        for (auto& worker : workers_) worker.tick(bus::monotonic_now());
        server_.tick(bus::monotonic_now());
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
    auto report = coordinator.run([this](const search::GenerationSeams& seams) {
      return generate(task, small(), kSeed, seams);
    });
    if (report) coordinator.drain(0);
    testing::handle_all(bus);  // what was sent last has yet to be received
    return report;
  }

  jobs::TaskShape shape() const {
    return {static_cast<int>(task.scene.size()), action_count(task.push)};
  }

  const tasks::Task task = gathering();
  bus::Bus bus{"memq://", bus::RunKey::random("test")};
  CoordinatorNode coordinator;
  std::vector<double> poses, next_poses;  // as streamed
  std::vector<int> actions, successes, sources;

 private:
  void on_rows(const transition_batch_t& m) {
    EXPECT_EQ(m.first, static_cast<std::int64_t>(actions.size()));
    poses.insert(poses.end(), m.poses.begin(), m.poses.end());
    next_poses.insert(next_poses.end(), m.next_poses.begin(), m.next_poses.end());
    actions.insert(actions.end(), m.action.begin(), m.action.end());
    successes.insert(successes.end(), m.success.begin(), m.success.end());
    sources.insert(sources.end(), m.source.begin(), m.source.end());
  }

  jobs::WorkerNode<jobs::ReplayService> server_;
  std::list<jobs::WorkerNode<jobs::ReverseService>> workers_;
};

std::string without_times(search::GenerationReport report) {
  report.stats.times = {};
  report.generate_wall_s = report.generate_cpu_s = 0.0;
  return to_json(report);
}

class GraphOf : public ::testing::TestWithParam<int> {};

TEST_P(GraphOf, StreamsTheBytesOfTheDirectCall) {
  Graph graph(GetParam());
  const auto report = graph.run();
  testing::GenerationRun direct = testing::run_naive(graph.task, small(), kSeed, 1);
  RowDigest rows;
  rows.add(direct.stored);
  direct.report.rows_sha256 = rows.hex();
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(without_times(*report), without_times(direct.report));
  std::vector<double> poses, next_poses;
  for (std::size_t k = 0; k < direct.stored.size(); ++k) {
    const search::Transition& t = direct.stored[k];
    jobs::append_poses(t.poses, poses);
    jobs::append_poses(t.next, next_poses);
    ASSERT_LT(k, graph.actions.size());
    ASSERT_EQ(graph.actions[k], t.action);
    ASSERT_EQ(graph.successes[k], t.success);
    ASSERT_EQ(graph.sources[k], static_cast<int>(t.source));
  }
  EXPECT_EQ(graph.poses, poses);
  EXPECT_EQ(graph.next_poses, next_poses);
  EXPECT_EQ(report->units_given_up, 0);
}

INSTANTIATE_TEST_SUITE_P(Workers, GraphOf, ::testing::Values(1, 3));

TEST(CoordinatorNode, AStopEndsTheSearchWithoutAReport) {
  std::atomic<bool> stop = false;
  Graph graph(1, [&] { return stop.load(); });
  graph.bus.subscribe<transition_batch_t>("RTG_TRANSITION",
                                          [&](const transition_batch_t&) { stop = true; });
  EXPECT_FALSE(graph.run().has_value());
  EXPECT_GT(graph.actions.size(), 0U);
  EXPECT_LT(graph.actions.size(), 1200U);
}

TEST(CoordinatorNode, ASearchThatIsCutShortByAStopHasNoReport) {
  bus::Bus bus("memq://", bus::RunKey::random("test"));
  std::atomic<bool> stop = false;
  CoordinatorNode coordinator(bus, {{1, 48}, kConfig, 10, [&] { return stop.load(); }});
  const auto report = coordinator.run([&](const search::GenerationSeams& seams) {
    stop = true;
    while (!seams.cancelled()) std::this_thread::yield();
    return search::GenerationReport{};
  });
  EXPECT_FALSE(report.has_value());
}

TEST(CoordinatorNode, WhatTheSearchThrowsComesOut) {
  bus::Bus bus("memq://", bus::RunKey::random("test"));
  CoordinatorNode coordinator(bus, {{1, 48}, kConfig, 10, [] { return false; }});
  EXPECT_THROW(coordinator.run([](const search::GenerationSeams&) -> search::GenerationReport {
    throw std::range_error("boom");
  }),
               std::range_error);
}

TEST(CoordinatorNode, WhatAHandlerThrowsComesOutAndEndsTheSearch) {
  bus::Bus bus("memq://", bus::RunKey::random("test"));
  CoordinatorNode coordinator(bus, {{1, 48}, kConfig, 10, [] { return false; }});
  bus.subscribe<search_progress_t>(
      "RTG_PROGRESS", [](const search_progress_t&) { throw std::range_error("boom"); });
  EXPECT_THROW(coordinator.run([](const search::GenerationSeams& seams) {
    const reverse::ReverseJob job{{{}}, 0};
    seams.solve({&job, 1});  // nobody is there to answer
    return search::GenerationReport{};
  }),
               std::range_error);
}

TEST(CoordinatorNode, SaysWhereItStandsAndThatItLeaves) {
  bus::Bus bus("memq://", bus::RunKey::random("test"));
  std::vector<search_progress_t> heard;
  std::atomic<bool> said = false;
  bus.subscribe<search_progress_t>("RTG_PROGRESS", [&](const search_progress_t& m) {
    heard.push_back(m);
    said = true;
    said.notify_all();
  });
  {
    CoordinatorNode coordinator(bus, {{1, 48}, kConfig, 10, [] { return false; }});
    const auto report = coordinator.run([&](const search::GenerationSeams& seams) {
      seams.progress({"round 1", 3, 24, 5, 99, 0.25, 7});
      said.wait(false);
      return search::GenerationReport{};
    });
    EXPECT_TRUE(report.has_value());
    coordinator.drain(0);
  }
  testing::handle_all(bus);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard[0].phase, "round 1");
  EXPECT_EQ(heard[0].layer, 3);
  EXPECT_EQ(heard[0].depth, 24);
  EXPECT_EQ(heard[0].transitions, 0) << "none is streamed yet";
  EXPECT_EQ(heard[0].contact_share, 0.25);
  EXPECT_EQ(heard[0].starts_reached, 7);
  EXPECT_EQ(heard[0].target, 10);
  EXPECT_EQ(heard[0].leaving, 0);
  EXPECT_EQ(heard.back().phase, "finished");
  EXPECT_EQ(heard.back().leaving, 1);
}

}  // namespace
}  // namespace rtg::beam_coordinator
