#pragma once

#include <string>
#include <vector>

#include "core/search/coverage.hpp"
#include "core/search/search_config.hpp"
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
  Coverage::Figures coverage = {};  // of the stored transitions
  SearchStats stats = {};
  std::string undrawn_reason = {};  // why most of stats.undrawn_goals were; empty without any
  int trees = 0;
  int start_region_depth = -1;   // least depth of a node in_start_region(); -1: none
  long units_given_up = 0;       // job messages whose workers were lost, several times; over LCM
  long units_from_journal = 0;   // answered by an earlier process of the run
  std::string rows_sha256 = {};  // digest of the stored transitions; empty if nobody took it
  double generate_wall_s = 0.0;
  double generate_cpu_s = 0.0;  // of this process alone, not of workers
  std::vector<ReportNode> nodes = {};
  std::vector<std::string> shortfalls = {};  // see set_shortfalls()
};

/// Writes the nodes, the number of trees, start_region_depth and undrawn_reason into `report`, of
/// which the stats are filled in.
void set_nodes(GenerationReport& report, const tasks::Task& task, std::vector<ReportNode> nodes);

/// Writes into `report`, a sentence each, what a search that has ended did not find: a step that
/// moves an object, as many transitions as `config` asks for. Programs then end with status 1.
void set_shortfalls(GenerationReport& report, const SearchConfig& config);

/// Returns the report as JSON text, one flat object. `statuses` becomes one key per SolveStatus,
/// iterations and replay gaps become medians and 90th percentiles.
std::string to_json(const GenerationReport& report);

}  // namespace rtg::search
