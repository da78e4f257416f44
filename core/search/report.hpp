#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/reverse/problem/solve_status.hpp"
#include "core/search/coverage.hpp"
#include "core/search/search_stats.hpp"
#include "core/world/pose.hpp"

namespace rtg::search {

/// A node of the stored search graph, for coverage pictures.
struct ReportNode {
  Poses poses;
  int depth = 0;  // actions until success
  int tree = 0;   // number of the tree
};

/// The account of a generation: the generation part of summary.json plus the samples behind its
/// pictures.
struct GenerationReport {
  long transitions = 0;
  long tree_transitions = 0, branch_transitions = 0;  // of them by source, the two of reverse trees
  double contact_share = 0.0;         // share of them that moved an object by more than 0.05 m
  double multi_body_share = 0.0;      // ... two or more that no joint connects
  double headings_per_state = 0.0;    // distinct headings stored from a state, mean over the states
  long start_region_transitions = 0;  // that begin in the start region
  int start_region_depth = -1;  // least depth of a node in the start region; -1: never reached
  int trees = 0;
  long candidates = 0;  // reverse jobs asked for, pruned ones included
  std::array<long, reverse::kSolveStatusCount> statuses{};  // by SolveStatus
  // As in SearchStats.
  long illegal_starts = 0, undrawn_goals = 0, unsettled_goals = 0, replays = 0, rejected_pushes = 0;
  long units_given_up = 0;  // of work, as no worker survived them; the coordinator fills it in
  double iterations_median = 0.0, iterations_p90 = 0.0;  // over converged ones
  long pushing_converged = 0;                            // that moved an object
  double pushing_iterations_median = 0.0, pushing_iterations_p90 = 0.0;
  double replay_gap_median = 0.0, replay_gap_p90 = 0.0;  // [m]
  double reverse_cpu_s = 0.0, replay_cpu_s = 0.0, generate_wall_s = 0.0;
  double generate_cpu_s = 0.0;     // of this process; solves and replays elsewhere left out
  std::vector<float> replay_gaps;  // one per replayed candidate [m]
  std::vector<ReportNode> nodes;
};

/// Writes into `report` what the stored transitions cover.
void fill(GenerationReport& report, const Coverage& coverage);

/// Takes the nodes of the trees.
void fill(GenerationReport& report, const tasks::Task& task, std::vector<ReportNode> nodes);

/// Writes into `report` what `stats` has counted, with the medians and 90th percentiles.
void fill(GenerationReport& report, const SearchStats& stats);

/// The report as JSON text, keys as the fields above (pruned, converged and the other statuses by
/// name).
std::string to_json(const GenerationReport& report);

}  // namespace rtg::search
