#include "core/search/generate.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/search/beam_search.hpp"
#include "core/search/forward_search.hpp"
#include "core/search/generation.hpp"
#include "core/search/walks.hpp"
#include "core/threads/cpu_clock.hpp"

namespace rtg::search {
namespace {

/// Returns by body how far its centre is from its place in `start` [m], in the node in which the
/// sum of these over all bodies but the robot is least.
std::vector<double> least_distances(std::span<const Node> nodes, const Poses& start) {
  const auto away = [&](const Node& node) {
    std::vector<double> out;
    for (std::size_t b = 0; b < start.size(); ++b)
      out.push_back((node.poses[b].position() - start[b].position()).norm());
    return out;
  };
  return away(*std::ranges::min_element(nodes, {}, [&](const Node& node) {
    const std::vector<double> distances = away(node);
    return std::accumulate(distances.begin() + 1, distances.end(), 0.0);
  }));
}

/// Runs Algorithm 1 once: draws a start and grows a tree from goal states towards it. Ends after
/// run.layers() layers. Ends earlier if config.patience layers in a row come no nearer to the
/// start.
void grow_tree(Generation& run, int number) {
  Rng rng = run.attempt_rng(number);
  const std::string phase = "tree " + std::to_string(run.attempts + number + 1);
  const Poses target = run.draw_start(rng);
  BeamSearch search(run.task, run.config, target, rng.word(), run.seams.paces);
  search.make_roots(run.replay(Stage::kGoals), run.stats);
  if (search.nodes().empty()) return;
  run.starts.push_back({target});
  double best = search.min_start_distance();
  int patience = run.config.patience;
  for (int layer = 1; layer <= run.layers() && patience > 0; ++layer) {
    if (search.beam().empty() || run.data.full() || run.cancelled()) break;
    run.data.store(search.grow(run.seams.solve, run.seams.replay, run.stats),
                   run.replay(Stage::kBranches));
    run.starts.back().depth = search.start_depth();
    run.show(phase, layer, run.layers());
    const double nearest = search.min_start_distance();
    patience = nearest < best ? run.config.patience : patience - 1;
    best = std::min(best, nearest);
  }
  run.starts.back().away = least_distances(search.nodes(), target);
  for (const Node& n : search.nodes()) run.nodes.push_back({n.poses, n.depth});
}

}  // namespace

GenerationReport generate(const tasks::Task& task, const SearchConfig& config, std::uint64_t seed,
                          const GenerationSeams& seams) {
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_before = threads::process_cpu_s();
  Generation run{task, config, seed, seams};
  run.repeat([&](int number) {
    switch (config.generator) {
      case Generator::kRrbs:
      case Generator::kNaive:
        return grow_tree(run, number);
      case Generator::kForward:
        return search_forward(run, number);
      case Generator::kScatter:
      case Generator::kRandom:
        return walk(run, number);
    }
  });
  GenerationReport report{run.data.coverage().figures(), std::move(run.stats)};
  if (report.stats.undrawn_goals > 0)
    report.undrawn_reason = main_reason(report.stats.goal_refusals, task.scene);
  report.starts = std::move(run.starts);
  report.nodes = std::move(run.nodes);
  set_shortfalls(report, config);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  report.generate_wall_s = wall.count();
  report.generate_cpu_s = threads::process_cpu_s() - cpu_before;
  return report;
}

}  // namespace rtg::search
