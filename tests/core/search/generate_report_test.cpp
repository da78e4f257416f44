#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/math/quantile.hpp"
#include "core/search/coverage.hpp"
#include "core/search/generate.hpp"
#include "tests/support/dragging_world.hpp"

namespace rtg::search {
namespace {

constexpr double kSolveTime = 2.0, kReplayTime = 0.5;  // that each answer claims [s]

/// A world that misses what is asked of it and notes what passes the seams.
struct NotingWorld : testing::DraggingWorld {
  std::vector<double> gaps;     // of simulated steps as they were solved for [m]
  std::vector<int> iterations;  // of converged solves
  std::vector<int> pushing;     // of those of them that moved an object
  std::vector<Poses> expanded;  // states that were solved for
  std::vector<Transition> stored;
  int settled = 0;  // goal states

  NotingWorld() {
    over = 0.1;
    aside = 0.2;
    task.start = {{0, -5, 0}, {-1.3, 0, 0}, {0, 0, 0}, {3.25, 0, 0}};
    task.horizon = 10;
  }

  GenerationSeams seams() {
    return {[this](auto jobs) { return noted_solve(jobs); },
            [this](auto jobs) { return noted_replay(jobs); },
            [this](auto batch) { stored.insert(stored.end(), batch.begin(), batch.end()); }};
  }

 private:
  /// Solves take 1 to 40 iterations, those that move an object 20 more; every 7th gives up after 50
  /// more.
  std::vector<reverse::ReverseResult> noted_solve(std::span<const reverse::ReverseJob> jobs) {
    std::vector<reverse::ReverseResult> answers = solve(jobs);
    wanted_.clear();
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      reverse::ReverseResult& answer = answers[k];
      const bool pushes = moves(answer.predecessors[0], jobs[k].end);
      answer.iterations = (pushes ? 21 : 1) + static_cast<int>(k % 40);
      if (k % 7 == 0) {
        answer = {reverse::SolveStatus::kIterationLimit, answer.iterations + 50};
      } else {
        iterations.push_back(answer.iterations);
        if (pushes) pushing.push_back(answer.iterations);
      }
      if (k % static_cast<std::size_t>(task.push.headings) == 0) expanded.push_back(jobs[k].end);
      answer.cpu_s = kSolveTime;
      for (const Poses& start : answer.predecessors)
        wanted_[reverse::key_of(to_single(start), jobs[k].action)] = jobs[k].end;
    }
    to_come_ = true;
    return answers;
  }

  /// The first batch after the solves is that of the first pushes of plans.
  std::vector<ReplayResult> noted_replay(std::span<const ReplayJob> jobs) {
    std::vector<ReplayResult> results = replay(jobs);
    for (ReplayResult& result : results) result.cpu_s = kReplayTime;
    for (const ReplayJob& job : jobs) settled += job.action == kSettle;
    if (to_come_)
      for (std::size_t k = 0; k < jobs.size(); ++k) {
        const auto wanted = wanted_.find(reverse::key_of(jobs[k].start, jobs[k].action));
        if (wanted != wanted_.end()) gaps.push_back(gap(wanted->second, results[k].end));
      }
    to_come_ = false;
    return results;
  }

  static bool moves(const Poses& a, const Poses& b) {
    for (std::size_t k = 1; k < a.size(); ++k)
      if (std::hypot(a[k].x - b[k].x, a[k].y - b[k].y) > 0.05) return true;
    return false;
  }

  static double gap(const Poses& a, const Poses& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += std::hypot(a[k].x - b[k].x, a[k].y - b[k].y);
    return sum / static_cast<double>(a.size());
  }

  std::map<std::uint64_t, Poses>
      wanted_;  // end that a start and action of the layer were found for
  bool to_come_ = false;
};

/// A generation in that world.
struct Noted {
  NotingWorld world;
  GenerationReport report;

  Noted() {
    SearchConfig config;
    config.transitions = 1500;
    config.breadth = 8;
    report = generate(world.task, config, 9, world.seams());
  }
};

struct GenerationReportTest : ::testing::Test {
  static const Noted& noted() {
    static const Noted once;
    return once;
  }
  const NotingWorld& world = noted().world;
  const GenerationReport& report = noted().report;
};

TEST_F(GenerationReportTest, GapsAreThoseBetweenWhatWasSolvedForAndWhatReplayed) {
  // The world also takes a step that was put into the start of another for that one.
  EXPECT_GE(report.stats.gaps.size(), 2 * world.gaps.size() / 3);
  std::vector<double> left = world.gaps;
  for (const float gap : report.stats.gaps) {
    const auto same =
        std::ranges::find_if(left, [&](double other) { return std::abs(gap - other) < 1e-7; });
    ASSERT_NE(same, left.end()) << gap;
    left.erase(same);
  }
  EXPECT_GT(quantile(report.stats.gaps, 0.75), 0.01);
}

TEST_F(GenerationReportTest, IterationsAreThoseOfConvergedSolves) {
  EXPECT_EQ(report.stats.iterations, world.iterations);
  EXPECT_EQ(report.stats.pushing_iterations, world.pushing);
  EXPECT_LT(world.pushing.size(), world.iterations.size());
}

TEST_F(GenerationReportTest, EachStageHasTheTimesOfItsBatches) {
  const auto time = [&](Stage stage) {
    return report.stats.times[static_cast<std::size_t>(stage)];
  };
  double wall_s = 0.0, replay_cpu_s = 0.0;
  for (const StageTime& stage : report.stats.times) {
    EXPECT_GT(stage.wall_s, 0.0);
    wall_s += stage.wall_s;
    replay_cpu_s += stage.cpu_s;
  }
  EXPECT_LT(wall_s, report.generate_wall_s);
  EXPECT_EQ(time(Stage::kSolves).cpu_s, kSolveTime * static_cast<double>(report.stats.candidates));
  replay_cpu_s -= time(Stage::kSolves).cpu_s;
  EXPECT_EQ(replay_cpu_s, kReplayTime * static_cast<double>(report.stats.replays));
  EXPECT_EQ(time(Stage::kGoals).cpu_s, kReplayTime * world.settled);
  EXPECT_GE(time(Stage::kReplays).cpu_s,
            kReplayTime * static_cast<double>(report.coverage.of(Source::kTree)));
  EXPECT_GE(time(Stage::kBranches).cpu_s,
            kReplayTime * static_cast<double>(report.coverage.of(Source::kBranch)));
}

TEST_F(GenerationReportTest, CoverageIsThatOfTheStoredTransitions) {
  long trees = 0;
  for (const Transition& t : world.stored) trees += t.source == Source::kTree;
  EXPECT_EQ(report.coverage.of(Source::kTree), trees);
  EXPECT_EQ(report.coverage.of(Source::kBranch), 1500 - trees);
}

double distance(const Pose& a, const Pose& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST_F(GenerationReportTest, EachTreeTellsHowNearItsStartItCame) {
  const auto has_node = [&](auto condition) {
    return std::ranges::any_of(report.nodes, condition);
  };
  for (const TreeStart& start : report.starts) {
    for (std::size_t b = 0; b < start.poses.size(); ++b)
      EXPECT_TRUE(has_node([&](const ReportNode& n) {
        return distance(n.poses[b], start.poses[b]) == start.away[b];
      })) << b;
    if (!start.reached()) continue;
    EXPECT_GT(start.depth, 0);
    EXPECT_TRUE(has_node([&](const ReportNode& n) {
      bool near = n.depth == start.depth;
      for (std::size_t b = 1; b < start.poses.size(); ++b)
        near = near && distance(n.poses[b], start.poses[b]) <= 0.4;
      return near;
    }));
  }
  EXPECT_GT(starts_reached(report.starts), 0);
}

TEST_F(GenerationReportTest, HasEveryNodeThatWasExpanded) {
  for (const Poses& poses : world.expanded)
    ASSERT_NE(std::ranges::find(report.nodes, poses, &ReportNode::poses), report.nodes.end());
}

}  // namespace
}  // namespace rtg::search
