#pragma once

#include <span>
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
};

/// A start state that a tree grew towards.
struct TreeStart {
  Poses poses;
  int depth = -1;                 // BeamSearch::start_depth() of the tree
  std::vector<double> away = {};  // of each body's centre from its place in the nearest node [m]

  bool reached() const { return depth >= 0; }
};

/// Returns how many of the starts were reached.
long starts_reached(std::span<const TreeStart> starts);

/// Figures of a run's generation for summary.json, and the samples for its plots.
struct GenerationReport {
  Coverage::Figures coverage = {};  // of the stored transitions
  SearchStats stats = {};
  std::string undrawn_reason = {};  // why most of stats.undrawn_goals were; empty without any
  long units_given_up = 0;          // job messages whose workers were lost, several times; over LCM
  long units_from_journal = 0;      // answered by an earlier process of the run
  long journal_bytes_dropped = 0;   // torn, damaged or of other settings
  std::string rows_sha256 = {};     // digest of the stored transitions; empty if nobody took it
  double generate_wall_s = 0.0;
  double generate_cpu_s = 0.0;               // of this process alone, not of workers
  std::vector<TreeStart> starts = {};        // by tree
  std::vector<ReportNode> nodes = {};        // of all trees
  std::vector<std::string> shortfalls = {};  // see set_shortfalls()
};

/// Writes into `report`, a sentence each, what a search that has ended did not find: a step that
/// moves an object, as many transitions as `config` asks for. Programs then end with status 1.
void set_shortfalls(GenerationReport& report, const SearchConfig& config);

/// Returns the report as JSON text, one flat object. `statuses` becomes one key per SolveStatus,
/// iterations and replay gaps become medians and 90th percentiles, depths of starts their median.
std::string to_json(const GenerationReport& report);

}  // namespace rtg::search
