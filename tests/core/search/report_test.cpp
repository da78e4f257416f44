#include "core/search/report.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace rtg::search {
namespace {

/// A report whose numbers all differ and are exact in single precision.
GenerationReport filled() {
  GenerationReport r;
  r.coverage = {1, {70, 71, 72, 73}, 0.25, 0.125, 4.5};
  r.starts = {{{{0.25, 0.75, 1.5}}, 5, {0.5, 1.25}}, {{{-1.0, 2.5, 0.0}}}};
  r.stats.candidates = 6;
  for (std::size_t k = 0; k < r.stats.statuses.size(); ++k)
    r.stats.statuses[k] = 10 + static_cast<long>(k);
  r.stats.illegal_starts = 20;
  r.stats.goal_draws = 27;
  r.stats.undrawn_goals = 25;
  r.undrawn_reason = "task.goal.0";
  r.stats.unsettled_goals = 21;
  r.stats.rejected_pushes = 22;
  r.stats.replays = 24;
  r.units_given_up = 23;
  r.units_from_journal = 26;
  r.journal_bytes_dropped = 28;
  r.rows_sha256 = "ab01";
  r.stats.iterations = {31, 29, 30};
  r.stats.pushing_iterations = {32, 35, 33, 34};
  r.stats.gaps = {0.0625F, 0.03125F, 0.375F};
  r.stats.times = {{{1.5, 2.5}, {3.5, 40.5}, {6.5, 13.0}, {8.5, 26.0}}};
  r.generate_wall_s = 42.5;
  r.generate_cpu_s = 43.5;
  r.shortfalls = {"too few", "none moves"};
  r.nodes = {{{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, 7}, {{{-0.5, 0.0, 0.5}}, 9}};
  return r;
}

TEST(Report, EveryFieldIsWrittenUnderItsName) {
  EXPECT_EQ(
      to_json(filled()),
      R"({"transitions":1,"tree_transitions":70,"branch_transitions":71,"contact_share":0.25,)"
      R"("multi_body_share":0.125,"headings_per_state":4.5,)"
      R"("trees":2,"starts_reached":1,"start_depth":5.0,"candidates":6,)"
      R"("converged":10,"acceptable":11,"pruned":12,"infeasible":13,"iteration_limit":14,)"
      R"("line_search_failed":15,"singular":16,"non_finite":17,)"
      R"("illegal_starts":20,"goal_draws":27,"undrawn_goals":25,)"
      R"("undrawn_reason":"task.goal.0","unsettled_goals":21,"replays":24,"rejected_pushes":22,)"
      R"("units_given_up":23,"units_from_journal":26,"journal_bytes_dropped":28,)"
      R"("iterations_median":30.0,"iterations_p90":31.0,"pushing_converged":4,)"
      R"("pushing_iterations_median":34.0,"pushing_iterations_p90":35.0,)"
      R"("replay_gap_median":0.0625,"replay_gap_p90":0.375,)"
      R"("reverse_cpu_s":40.5,"replay_cpu_s":41.5,)"
      R"("generation_stages":{"goals":{"wall_s":1.5,"cpu_s":2.5},"solves":{"wall_s":3.5,"cpu_s":40.5},)"
      R"("replays":{"wall_s":6.5,"cpu_s":13.0},)"
      R"("branches":{"wall_s":8.5,"cpu_s":26.0}},"generate_wall_s":42.5,"generate_cpu_s":43.5,)"
      R"("rows_sha256":"ab01",)"
      R"("shortfalls":["too few","none moves"],)"
      R"("iterations":[31,29,30],"pushing_iterations":[32,35,33,34],)"
      R"("replay_gaps":[0.0625,0.03125,0.375],"starts":[)"
      R"({"poses":[[0.25,0.75,1.5]],"depth":5,"away":[0.5,1.25]},)"
      R"({"poses":[[-1.0,2.5,0.0]],"depth":null,"away":[]}],"nodes":[)"
      R"({"poses":[[1.0,2.0,3.0],[4.0,5.0,6.0]],"depth":7},)"
      R"({"poses":[[-0.5,0.0,0.5]],"depth":9}]})");
}

TEST(Report, WithoutReverseStepsSaysNothingOfThem) {
  GenerationReport r = filled();
  r.stats.candidates = 0;
  const std::string json = to_json(r);
  for (const char* field : {"iterations_median", "iterations_p90", "pushing_iterations_median",
                            "pushing_iterations_p90", "replay_gap_median", "replay_gap_p90"})
    EXPECT_NE(json.find('"' + std::string(field) + "\":null,"), std::string::npos) << field;
  EXPECT_NE(json.find(R"("contact_share":0.25,)"), std::string::npos);
}

TEST(Report, TheDepthOfStartsIsTheMedianOfThoseThatWereReached) {
  GenerationReport report;
  report.starts = {{{}, 30}, {{}, -1}, {{}, 4}, {{}, 7}, {{}, -1}};
  EXPECT_EQ(starts_reached(report.starts), 3);
  EXPECT_NE(to_json(report).find(R"("trees":5,"starts_reached":3,"start_depth":7.0,)"),
            std::string::npos);
}

TEST(Report, TellsThatNoStepMovesAnObject) {
  GenerationReport report;
  report.coverage.transitions = 7;
  SearchConfig config;
  config.transitions = 7;
  const auto moves = [&](Generator generator, double contact_share, std::vector<int> pushing) {
    config.generator = generator;
    report.coverage.contact_share = contact_share;
    report.stats.pushing_iterations = std::move(pushing);
    report.shortfalls.clear();
    set_shortfalls(report, config);
    return report.shortfalls.empty();
  };
  // A branch may move an object though no reverse step does.
  EXPECT_FALSE(moves(Generator::kRrbs, 0.1, {}));
  EXPECT_EQ(report.shortfalls,
            std::vector<std::string>{
                "the search (rrbs) found no step that moves an object, see generation.json"});
  EXPECT_TRUE(moves(Generator::kRrbs, 0.1, {3}));
  EXPECT_FALSE(moves(Generator::kNaive, 0.0, {3}));
  EXPECT_TRUE(moves(Generator::kNaive, 0.1, {}));
}

TEST(Report, TellsThatFewerTransitionsWereFoundThanAskedFor) {
  GenerationReport report;
  report.stats.pushing_iterations = {3};
  SearchConfig config;
  config.transitions = 1234567;
  for (const auto& [found, words] : {std::pair(0L, "0"), {999L, "999"}, {1021L, "1021"}}) {
    report.coverage.transitions = found;
    report.shortfalls.clear();
    set_shortfalls(report, config);
    ASSERT_EQ(report.shortfalls.size(), 1U);
    EXPECT_EQ(report.shortfalls[0],
              "the search (rrbs) found " + std::string(words) +
                  " transitions of the 1234567 asked for and then nothing more, see "
                  "generation.json; a wider one may find more (search.breadth, "
                  "search.plans_per_node)");
  }
}

TEST(Report, NamesTheBreadthOfTheSearchThatFellShort) {
  GenerationReport report;
  SearchConfig config;
  config.generator = Generator::kForward;
  set_shortfalls(report, config);
  ASSERT_EQ(report.shortfalls.size(), 1U);
  EXPECT_TRUE(report.shortfalls[0].ends_with("may find more (search.forward_breadth)"));
}

TEST(Report, OfNothingHasEmptyListsAndNoDepth) {
  const std::string text = to_json({});
  EXPECT_NE(text.find(R"("trees":0,"starts_reached":0,"start_depth":null,)"), std::string::npos);
  EXPECT_TRUE(text.ends_with(
      R"("iterations":[],"pushing_iterations":[],"replay_gaps":[],"starts":[],"nodes":[]})"));
}

}  // namespace
}  // namespace rtg::search
