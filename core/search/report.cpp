#include "core/search/report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "core/math/quantile.hpp"
#include "core/search/start_distance.hpp"

namespace rtg::search {

void fill(GenerationReport& report, const Coverage& coverage) {
  report.transitions = coverage.transitions();
  report.tree_transitions = coverage.of(Source::kTree);
  report.branch_transitions = coverage.of(Source::kBranch);
  report.contact_share = coverage.contact_share();
  report.multi_body_share = coverage.multi_body_share();
  report.headings_per_state = coverage.headings_per_state();
  report.start_region_transitions = coverage.start_region();
}

void fill(GenerationReport& report, const tasks::Task& task, std::vector<ReportNode> nodes) {
  const StateMetric metric(task.scene);
  for (const ReportNode& n : nodes) {
    report.trees = std::max(report.trees, n.tree + 1);
    if (n.depth == 0 || !in_place(metric, n.poses, task.start)) continue;
    int& least = report.start_region_depth;
    least = least < 0 ? n.depth : std::min(least, n.depth);
  }
  report.nodes = std::move(nodes);
}

void fill(GenerationReport& report, const SearchStats& stats) {
  report.candidates = stats.candidates;
  report.statuses = stats.statuses;
  report.illegal_starts = stats.illegal_starts;
  report.undrawn_goals = stats.undrawn_goals;
  report.unsettled_goals = stats.unsettled_goals;
  report.replays = stats.replays;
  report.rejected_pushes = stats.rejected_pushes;
  report.iterations_median = quantile(stats.iterations, 0.5);
  report.iterations_p90 = quantile(stats.iterations, 0.9);
  report.pushing_converged = static_cast<long>(stats.pushing_iterations.size());
  report.pushing_iterations_median = quantile(stats.pushing_iterations, 0.5);
  report.pushing_iterations_p90 = quantile(stats.pushing_iterations, 0.9);
  report.replay_gap_median = quantile(stats.gaps, 0.5);
  report.replay_gap_p90 = quantile(stats.gaps, 0.9);
  report.reverse_cpu_s = stats.reverse_cpu_s;
  report.replay_cpu_s = stats.replay_cpu_s;
  report.replay_gaps = stats.gaps;
}

namespace {

nlohmann::ordered_json to_json(std::span<const ReportNode> nodes) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const ReportNode& n : nodes) {
    nlohmann::ordered_json poses = nlohmann::ordered_json::array();
    for (const Pose& p : n.poses) poses.push_back({p.x, p.y, p.theta});
    out.push_back({{"poses", poses}, {"depth", n.depth}, {"tree", n.tree}});
  }
  return out;
}

}  // namespace

std::string to_json(const GenerationReport& r) {
  // Returns the value, or null if the run solved for no reverse steps.
  const auto searched = [&r](double value) {
    return r.candidates > 0 ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json out = {{"transitions", r.transitions},
                                {"tree_transitions", r.tree_transitions},
                                {"branch_transitions", r.branch_transitions},
                                {"contact_share", r.contact_share},
                                {"multi_body_share", r.multi_body_share},
                                {"headings_per_state", r.headings_per_state},
                                {"start_region_transitions", r.start_region_transitions},
                                {"start_region_depth", r.start_region_depth},
                                {"trees", r.trees},
                                {"candidates", r.candidates}};
  for (std::size_t k = 0; k < r.statuses.size(); ++k)
    out[std::string(name(static_cast<reverse::SolveStatus>(k)))] = r.statuses[k];
  out["illegal_starts"] = r.illegal_starts;
  out["undrawn_goals"] = r.undrawn_goals;
  out["unsettled_goals"] = r.unsettled_goals;
  out["replays"] = r.replays;
  out["rejected_pushes"] = r.rejected_pushes;
  out["units_given_up"] = r.units_given_up;
  out["iterations_median"] = searched(r.iterations_median);
  out["iterations_p90"] = searched(r.iterations_p90);
  out["pushing_converged"] = r.pushing_converged;
  out["pushing_iterations_median"] = searched(r.pushing_iterations_median);
  out["pushing_iterations_p90"] = searched(r.pushing_iterations_p90);
  out["replay_gap_median"] = searched(r.replay_gap_median);
  out["replay_gap_p90"] = searched(r.replay_gap_p90);
  out["reverse_cpu_s"] = r.reverse_cpu_s;
  out["replay_cpu_s"] = r.replay_cpu_s;
  out["generate_wall_s"] = r.generate_wall_s;
  out["generate_cpu_s"] = r.generate_cpu_s;
  out["replay_gaps"] = r.replay_gaps;
  out["nodes"] = to_json(r.nodes);
  return out.dump();
}

}  // namespace rtg::search
