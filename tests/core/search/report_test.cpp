#include "core/search/report.hpp"

#include <gtest/gtest.h>

#include "tests/support/gathering.hpp"

namespace rtg::search {
namespace {

/// A report whose numbers all differ and are exact in single precision.
GenerationReport filled() {
  GenerationReport r;
  r.transitions = 1;
  r.tree_transitions = 70;
  r.branch_transitions = 71;
  r.contact_share = 0.25;
  r.multi_body_share = 0.125;
  r.start_region_transitions = 2;
  r.headings_per_state = 4.5;
  r.start_region_depth = 5;
  r.trees = 3;
  r.candidates = 6;
  for (std::size_t k = 0; k < r.statuses.size(); ++k) r.statuses[k] = 10 + static_cast<long>(k);
  r.illegal_starts = 20;
  r.undrawn_goals = 25;
  r.unsettled_goals = 21;
  r.rejected_pushes = 22;
  r.replays = 24;
  r.units_given_up = 23;
  r.iterations_median = 30.0;
  r.iterations_p90 = 31.0;
  r.pushing_converged = 32;
  r.pushing_iterations_median = 33.0;
  r.pushing_iterations_p90 = 34.0;
  r.replay_gap_median = 0.0625;
  r.replay_gap_p90 = 0.375;
  r.reverse_cpu_s = 40.5;
  r.replay_cpu_s = 41.5;
  r.generate_wall_s = 42.5;
  r.generate_cpu_s = 43.5;
  r.replay_gaps = {1.5F, 2.5F};
  r.nodes = {{{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, 7, 8}, {{{-0.5, 0.0, 0.5}}, 9, 50}};
  return r;
}

TEST(Report, EveryFieldIsWrittenUnderItsName) {
  EXPECT_EQ(
      to_json(filled()),
      R"({"transitions":1,"tree_transitions":70,"branch_transitions":71,"contact_share":0.25,)"
      R"("multi_body_share":0.125,"headings_per_state":4.5,"start_region_transitions":2,)"
      R"("start_region_depth":5,"trees":3,"candidates":6,)"
      R"("converged":10,"pruned":11,"infeasible":12,"iteration_limit":13,)"
      R"("line_search_failed":14,"singular":15,"non_finite":16,)"
      R"("illegal_starts":20,"undrawn_goals":25,"unsettled_goals":21,"replays":24,"rejected_pushes":22,)"
      R"("units_given_up":23,)"
      R"("iterations_median":30.0,"iterations_p90":31.0,"pushing_converged":32,)"
      R"("pushing_iterations_median":33.0,"pushing_iterations_p90":34.0,)"
      R"("replay_gap_median":0.0625,"replay_gap_p90":0.375,)"
      R"("reverse_cpu_s":40.5,"replay_cpu_s":41.5,"generate_wall_s":42.5,"generate_cpu_s":43.5,)"
      R"("replay_gaps":[1.5,2.5],"nodes":[)"
      R"({"poses":[[1.0,2.0,3.0],[4.0,5.0,6.0]],"depth":7,"tree":8},)"
      R"({"poses":[[-0.5,0.0,0.5]],"depth":9,"tree":50}]})");
}

TEST(Report, WithoutReverseStepsSaysNothingOfThem) {
  GenerationReport r = filled();
  r.candidates = 0;
  const std::string json = to_json(r);
  for (const char* field : {"iterations_median", "iterations_p90", "pushing_iterations_median",
                            "pushing_iterations_p90", "replay_gap_median", "replay_gap_p90"})
    EXPECT_NE(json.find('"' + std::string(field) + "\":null,"), std::string::npos) << field;
  EXPECT_NE(json.find(R"("contact_share":0.25,)"), std::string::npos);
}

TEST(Report, OfNodesCountsTreesAndTheLeastDepthInTheStartRegionButForGoals) {
  const tasks::Task task = testing::gathering();
  Poses elsewhere = task.start;
  elsewhere[1].x += 2.0;
  GenerationReport report;
  fill(report, task, {{task.start, 0, 0}, {elsewhere, 3, 0}});
  EXPECT_EQ(report.start_region_depth, -1);
  fill(report, task,
       {{task.start, 0, 0}, {elsewhere, 3, 0}, {task.start, 7, 1}, {task.start, 5, 2}});
  EXPECT_EQ(report.start_region_depth, 5);
  EXPECT_EQ(report.trees, 3);
}

TEST(Report, OfNothingHasEmptyListsAndNoDepth) {
  const std::string text = to_json({});
  EXPECT_NE(text.find(R"("start_region_depth":-1,)"), std::string::npos);
  EXPECT_TRUE(text.ends_with(R"("replay_gaps":[],"nodes":[]})"));
}

}  // namespace
}  // namespace rtg::search
