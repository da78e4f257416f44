#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/reverse/problem/solve_status.hpp"
#include "core/search/coverage.hpp"
#include "core/search/search_stats.hpp"
#include "core/world/pose.hpp"

namespace rtg::search {

/// A node of a search tree, for plots of the coverage.
struct ReportNode {
  Poses poses;
  int depth = 0;  // actions until success
  int tree = 0;   // number of the tree
};

/// Figures of a run's generation for summary.json, and the samples for its plots.
struct GenerationReport {
  long transitions = 0;
  long tree_transitions = 0, branch_transitions = 0;  // with Source::kTree, kBranch
  double contact_share = 0.0;         // share that moves an object by more than 0.05 m
  double multi_body_share = 0.0;      // share that moves several unconnected objects
  double headings_per_state = 0.0;    // headings per distinct state, mean
  long start_region_transitions = 0;  // with all objects in_place() before the push
  int start_region_depth = -1;        // least depth of a node with all objects in_place(); -1: none
  int trees = 0;
  long candidates = 0;                                      // reverse jobs, pruned ones included
  std::array<long, reverse::kSolveStatusCount> statuses{};  // candidates by SolveStatus
  // As in SearchStats.
  long illegal_starts = 0, undrawn_goals = 0, unsettled_goals = 0, replays = 0, rejected_pushes = 0;
  long units_given_up = 0;  // job messages given up; set by the coordinator
  double iterations_median = 0.0, iterations_p90 = 0.0;  // over converged solves
  long pushing_converged = 0;                            // converged solves that moved an object
  double pushing_iterations_median = 0.0, pushing_iterations_p90 = 0.0;
  double replay_gap_median = 0.0, replay_gap_p90 = 0.0;  // [m]
  double reverse_cpu_s = 0.0, replay_cpu_s = 0.0, generate_wall_s = 0.0;
  double generate_cpu_s = 0.0;     // of this process alone, not of workers
  std::vector<float> replay_gaps;  // one per replayed candidate [m]
  std::vector<ReportNode> nodes;
};

/// Writes the coverage of the stored transitions into `report`.
void fill(GenerationReport& report, const Coverage& coverage);

/// Writes the nodes, the number of trees and start_region_depth into `report`.
void fill(GenerationReport& report, const tasks::Task& task, std::vector<ReportNode> nodes);

/// Writes the counts of `stats`, with medians and 90th percentiles, into `report`.
void fill(GenerationReport& report, const SearchStats& stats);

/// Returns the report as JSON text. The keys are the names of the fields above. `statuses` becomes
/// one key per SolveStatus.
std::string to_json(const GenerationReport& report);

}  // namespace rtg::search
