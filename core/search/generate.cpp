#include "core/search/generate.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
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

/// Nodes that trees grown together have in a layer, if one tree has less, and most such trees.
constexpr int kNodesTogether = 40, kTreesTogether = 10;

/// Returns how many trees to grow together, after `number` trees of the shard: as many as there are
/// transitions left for. The first tree grows alone, as it tells how many transitions one takes.
int trees_together(const Generation& run, int number) {
  const int most = std::clamp(kNodesTogether / run.config.breadth, 1, kTreesTogether);
  if (number == 0 || run.data.stored() == 0) return 1;
  const long left = run.data.left() * number / run.data.stored();  // of such trees
  return static_cast<int>(std::clamp(left, 1L, static_cast<long>(most)));
}

/// A tree that grows from goal states towards a start (Algorithm 1).
struct Tree {
  BeamSearch search;
  double best = 0.0;  // start_distance() that it has come to
  int patience = 0;   // layers in a row that may come no nearer
};

/// Returns tree `number` with its roots alone.
std::unique_ptr<Tree> planted(Generation& run, int number) {
  Rng rng = run.attempt_rng(number);
  Poses target = run.draw_start(rng);
  auto tree = std::make_unique<Tree>(
      Tree{BeamSearch(run.task, run.config, std::move(target), rng.word(), run.seams.paces)});
  tree->search.make_roots(run.replay(Stage::kGoals), run.stats);
  tree->best = tree->search.min_start_distance();
  tree->patience = run.config.patience;
  return tree;
}

/// Grows trees together, of which the first has the number `number`, and returns how many. A tree
/// ends after run.layers() layers, or if config.patience layers in a row come no nearer to its
/// start.
int grow_trees(Generation& run, int number) {
  const int count = trees_together(run, number);
  const std::string first = std::to_string(run.attempts + number + 1);
  const std::string phase =
      count == 1 ? "tree " + first
                 : "trees " + first + " to " + std::to_string(run.attempts + number + count);
  std::vector<std::unique_ptr<Tree>> trees;
  for (int k = 0; k < count; ++k) trees.push_back(planted(run, number + k));
  std::erase_if(trees, [](const auto& tree) { return tree->search.nodes().empty(); });
  const std::size_t starts = run.starts.size();
  for (const auto& tree : trees) run.starts.push_back({tree->search.target()});
  for (int layer = 1; layer <= run.layers(); ++layer) {
    std::vector<BeamSearch*> growing;
    std::vector<std::size_t> of_trees;  // indices of those in `growing`
    for (std::size_t k = 0; k < trees.size(); ++k) {
      if (trees[k]->patience == 0 || trees[k]->search.beam().empty()) continue;
      growing.push_back(&trees[k]->search);
      of_trees.push_back(k);
    }
    if (growing.empty() || run.data.full() || run.cancelled()) break;
    run.data.store(BeamSearch::grow_together(growing, run.seams.solve, run.seams.replay, run.stats),
                   run.replay(Stage::kBranches));
    for (const std::size_t k : of_trees) {
      Tree& tree = *trees[k];
      run.starts[starts + k].depth = tree.search.start_depth();
      const double nearest = tree.search.min_start_distance();
      tree.patience = nearest < tree.best ? run.config.patience : tree.patience - 1;
      tree.best = std::min(tree.best, nearest);
    }
    run.show(phase, layer, run.layers());
  }
  for (std::size_t k = 0; k < trees.size(); ++k) {
    const BeamSearch& search = trees[k]->search;
    run.starts[starts + k].away = least_distances(search.nodes(), search.target());
    for (const Node& n : search.nodes()) run.nodes.push_back({n.poses, n.depth});
  }
  return count;
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
        break;
      case Generator::kForward:
        search_forward(run, number);
        return 1;
      case Generator::kScatter:
      case Generator::kRandom:
        walk(run, number);
        return 1;
    }
    return grow_trees(run, number);
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
