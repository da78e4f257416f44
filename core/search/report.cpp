#include "core/search/report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/math/quantile.hpp"
#include "core/reverse/problem/solve_status.hpp"

namespace rtg::search {

long starts_reached(std::span<const TreeStart> starts) {
  return std::ranges::count_if(starts, &TreeStart::reached);
}

namespace {

/// Returns `value` if it is `known`, else null.
template <class Value>
nlohmann::ordered_json or_null(bool known, Value value) {
  return known ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

nlohmann::ordered_json to_json(const Poses& poses) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Pose& p : poses) out.push_back({p.x, p.y, p.theta});
  return out;
}

nlohmann::ordered_json to_json(std::span<const ReportNode> nodes) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const ReportNode& n : nodes)
    out.push_back({{"poses", to_json(n.poses)}, {"depth", n.depth}});
  return out;
}

nlohmann::ordered_json to_json(std::span<const TreeStart> starts) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const TreeStart& s : starts)
    out.push_back(
        {{"poses", to_json(s.poses)}, {"depth", or_null(s.reached(), s.depth)}, {"away", s.away}});
  return out;
}

/// Returns the median of the depths of the starts that were reached; null if none was.
nlohmann::ordered_json median_depth(std::span<const TreeStart> starts) {
  std::vector<int> depths;
  for (const TreeStart& s : starts)
    if (s.reached()) depths.push_back(s.depth);
  return or_null(!depths.empty(), quantile(depths, 0.5));
}

/// Returns which settings make a search of `generator` wider, in words; none do for walks.
std::string wider(Generator generator) {
  if (generator == Generator::kRandom || generator == Generator::kScatter) return "";
  return std::string("; a wider one may find more (") +
         (generator == Generator::kForward ? "search.forward_breadth)"
                                           : "search.breadth, search.plans_per_node)");
}

}  // namespace

void set_shortfalls(GenerationReport& report, const SearchConfig& config) {
  const std::string search = "the search (" +
                             std::string(kGenerators[static_cast<std::size_t>(config.generator)]) +
                             ") found ";
  const std::string found = std::to_string(report.coverage.transitions);
  const bool moves = config.generator == Generator::kRrbs ? !report.stats.pushing_iterations.empty()
                                                          : report.coverage.contact_share > 0.0;
  if (report.coverage.transitions > 0 && !moves)
    report.shortfalls.push_back(search + "no step that moves an object, see generation.json");
  if (report.coverage.transitions < config.transitions)
    report.shortfalls.push_back(
        search + found + " transitions of the " + std::to_string(config.transitions) +
        " asked for and then nothing more, see generation.json" + wider(config.generator));
}

std::string to_json(const GenerationReport& r) {
  const Coverage::Figures& c = r.coverage;
  const SearchStats& stats = r.stats;
  // Returns the quantile, or null if the run solved for no reverse steps.
  const auto of_search = [&stats](const auto& values, double share) {
    return or_null(stats.candidates > 0, quantile(values, share));
  };
  nlohmann::ordered_json out = {{"transitions", c.transitions},
                                {"tree_transitions", c.of(Source::kTree)},
                                {"branch_transitions", c.of(Source::kBranch)},
                                {"contact_share", c.contact_share},
                                {"multi_body_share", c.multi_body_share},
                                {"headings_per_state", c.headings_per_state},
                                {"trees", r.starts.size()},
                                {"starts_reached", starts_reached(r.starts)},
                                {"start_depth", median_depth(r.starts)},
                                {"candidates", stats.candidates}};
  for (std::size_t k = 0; k < stats.statuses.size(); ++k)
    out[std::string(name(static_cast<reverse::SolveStatus>(k)))] = stats.statuses[k];
  out["illegal_starts"] = stats.illegal_starts;
  out["goal_draws"] = stats.goal_draws;
  out["undrawn_goals"] = stats.undrawn_goals;
  out["undrawn_reason"] = r.undrawn_reason;
  out["unsettled_goals"] = stats.unsettled_goals;
  out["replays"] = stats.replays;
  out["rejected_pushes"] = stats.rejected_pushes;
  out["units_given_up"] = r.units_given_up;
  out["units_from_journal"] = r.units_from_journal;
  out["journal_bytes_dropped"] = r.journal_bytes_dropped;
  out["iterations_median"] = of_search(stats.iterations, 0.5);
  out["iterations_p90"] = of_search(stats.iterations, 0.9);
  out["pushing_converged"] = stats.pushing_iterations.size();
  out["pushing_iterations_median"] = of_search(stats.pushing_iterations, 0.5);
  out["pushing_iterations_p90"] = of_search(stats.pushing_iterations, 0.9);
  out["replay_gap_median"] = of_search(stats.gaps, 0.5);
  out["replay_gap_p90"] = of_search(stats.gaps, 0.9);
  double replay_cpu_s = 0.0;
  for (const StageTime& time : stats.times) replay_cpu_s += time.cpu_s;
  const double reverse_cpu_s = stats.times[static_cast<std::size_t>(Stage::kSolves)].cpu_s;
  out["reverse_cpu_s"] = reverse_cpu_s;
  out["replay_cpu_s"] = replay_cpu_s - reverse_cpu_s;
  for (std::size_t k = 0; k < stats.times.size(); ++k)
    out["generation_stages"][kStages[k]] = {{"wall_s", stats.times[k].wall_s},
                                            {"cpu_s", stats.times[k].cpu_s}};
  out["generate_wall_s"] = r.generate_wall_s;
  out["generate_cpu_s"] = r.generate_cpu_s;
  if (!r.rows_sha256.empty()) out["rows_sha256"] = r.rows_sha256;
  out["shortfalls"] = r.shortfalls;
  out["iterations"] = stats.iterations;
  out["pushing_iterations"] = stats.pushing_iterations;
  out["replay_gaps"] = stats.gaps;
  out["starts"] = to_json(r.starts);
  out["nodes"] = to_json(r.nodes);
  return out.dump();
}

}  // namespace rtg::search
