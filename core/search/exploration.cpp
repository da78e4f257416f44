#include "core/search/exploration.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/search/coverage.hpp"
#include "core/search/link_graph.hpp"
#include "core/search/lost_state.hpp"
#include "core/search/policy_learning.hpp"

namespace rtg {
namespace {

// Keys of its independent random streams.
enum Stream : std::uint64_t { kTrees = 1, kProbing, kProving };

constexpr int kProbes = 50;       // episodes that find a round's target and judge its policy
constexpr double kArrived = 0.5;  // a node so near is at its target [m], as in StateMetric
constexpr double kTurned = 0.5;   // Target::turned where angles matter [m]

/// Share of the probe starts from which success was reached.
double rating(std::span<const Episode> episodes) {
  const auto solved = std::ranges::count_if(episodes, &Episode::success);
  return static_cast<double>(solved) / kProbes;
}

}  // namespace

Exploration::Exploration(const Task& task, const SearchConfig& config, std::uint64_t seed,
                         const GenerationSeams& seams, SearchStats& stats)
    : task_(task),
      config_(config),
      seed_(seed),
      seams_(seams),
      stats_(stats),
      metric_(task.scene),
      search_(task, config, Rng(seed, kTrees << 32).word()),
      policy_(task) {}

bool Exploration::round(std::size_t limit, const AfterLayer& after_layer) {
  const std::size_t before = pool_.size(), known = search_.nodes().size();
  const std::vector<Poses> starts = probe_starts(kProbing);
  const std::vector<Episode> probes = follow(policy_, starts);
  const int proven = policy_.size();
  const double solved = rating(probes);
  mastered_ = solved < 1.0 ? 0 : mastered_ + 1;
  grow_towards({lost_state(probes).value_or(starts[0]), solved < 1.0 ? 0.0 : kTurned},
               solved > 0.0 ? config_.repair_breadth : config_.breadth, limit, after_layer);
  const std::size_t grown = pool_.size();
  replay_chains_from(known, before, limit);
  if (pool_.size() > grown) after_layer(0, grown);
  if (!cancelled()) improve_policy(proven, starts, solved);
  note_nodes(known);
  ++rounds_;
  return pool_.size() > before;
}

/// Layers until the trees have reached the target or patience with those that come no nearer is
/// over; leaves room for chains.
void Exploration::grow_towards(const Target& target, int breadth, std::size_t limit,
                               const AfterLayer& after_layer) {
  const auto room = static_cast<double>(limit - std::min(limit, pool_.size()));
  const auto layers = limit - static_cast<std::size_t>(config_.chain_share * room);
  const std::size_t known = search_.nodes().size();
  search_.aim(target, breadth, seams_.replay, stats_);
  double best = std::numeric_limits<double>::infinity();
  int patience = config_.patience;
  for (int layer = 1; layer <= config_.depth && pool_.size() < layers && !cancelled(); ++layer) {
    const std::size_t first = pool_.size();
    const auto growths = search_.grow(seams_.solve, seams_.replay, stats_);
    if (growths.empty()) break;
    add(growths);
    after_layer(layer, first);
    patience = search_.best() < best ? config_.patience : patience - 1;
    best = std::min(best, search_.best());
    if (patience <= 0 || arrivals(known, target.poses) >= config_.arrivals) break;
  }
}

/// Starts of this round's probes.
std::vector<Poses> Exploration::probe_starts(std::uint64_t stream) const {
  Rng rng(seed_, stream << 32 | static_cast<std::uint64_t>(rounds_));
  return jittered_starts(task_, kProbes, config_.target_jitter, rng);
}

/// None of the episodes while there is no policy.
std::vector<Episode> Exploration::follow(const TreePolicy& policy, std::span<const Poses> starts) {
  if (policy.size() == 0) return {};
  return run_episodes(task_, policy, {starts}, seams_.replay, stats_);
}

/// `proven`: entries that it had before the round; `before`: its rating with these.
void Exploration::improve_policy(int proven, std::span<const Poses> starts, double before) {
  const auto rate = [&](const TreePolicy& policy) { return rating(follow(policy, starts)); };
  const auto rate_anew = [this](const TreePolicy& policy) {
    return rating(follow(policy, probe_starts(kProving)));
  };
  climb(policy_, proven, before, rate, rate_anew);
}

/// How many nodes from index `first` on are at the target.
int Exploration::arrivals(std::size_t first, const Poses& target) const {
  const auto nodes = search_.nodes().subspan(first);
  return static_cast<int>(std::ranges::count_if(
      nodes, [&](const Node& n) { return metric_.distance(n.poses, target) <= kArrived; }));
}

/// Reports the nodes from index `first` on.
void Exploration::note_nodes(std::size_t first) {
  for (const Node& n : search_.nodes().subspan(first)) {
    nodes_.push_back({n.poses, n.depth, rounds_});
    if (n.depth == 0 || !in_start_region(task_, metric_, n.poses)) continue;
    int& least = start_region_depth_;
    least = least < 0 ? n.depth : std::min(least, n.depth);
  }
}

/// A state in which the goal holds ends an episode, so nothing starts there. A round that begins at
/// nodes of another finds some of their steps once more.
void Exploration::add(std::span<const BeamSearch::Growth> growths) {
  for (const BeamSearch::Growth& g : growths) {
    if (g.depth == 0) continue;
    const Predecessor& c = g.candidate;
    const Node& behind = search_.nodes()[static_cast<std::size_t>(c.parent)];
    std::optional<StepPool::Index> next;
    if (g.depth > 1 && metric_.within(c.end, behind.poses, LinkGraph::kLink))
      next = pool_.find(key_of(behind.poses, behind.action));
    pool_.add({c.start, c.action, c.end, succeeded(task_, c.end), Source::kStepReplay}, next);
    learn(g);
  }
}

/// One that misses serves only if it reaches the goal all the same.
void Exploration::learn(const BeamSearch::Growth& growth) {
  const Predecessor& c = growth.candidate;
  if (!repeatable(c, config_)) return;
  if (c.miss <= config_.gap_tolerance || succeeded(task_, c.end))
    learn_step(policy_, growth, search_.nodes());
}

/// The chains that begin nearest to the start, of nodes from index `first` on, for chain_share of
/// what the round has found, from index `before` on.
void Exploration::replay_chains_from(std::size_t first, std::size_t before, std::size_t limit) {
  const double share = config_.chain_share / (1.0 - config_.chain_share);
  auto wanted = static_cast<std::size_t>(static_cast<double>(pool_.size() - before) * share);
  wanted = std::min(wanted, limit - std::min(limit, pool_.size()));
  std::vector<std::pair<double, int>> order;
  const std::span<const Node> nodes = search_.nodes();
  for (std::size_t k = first; k < nodes.size(); ++k)
    if (nodes[k].depth > 1)  // a chain of one step is known already
      order.emplace_back(metric_.layout_distance(nodes[k].poses, task_.start), static_cast<int>(k));
  std::ranges::sort(order);
  std::vector<Chain> chains;
  std::size_t planned = 0;
  for (const auto& [distance, node] : order) {
    if (planned >= wanted) break;
    chains.push_back(search_.chain(node));
    planned += chains.back().actions.size() - 1;
  }
  for (const auto& steps : replay_chains(task_, chains, seams_.replay, stats_))
    add_plan(steps);  // the first step is, bit for bit, the one that found the chain's far end
}

void Exploration::add_plan(std::span<const Transition> steps) {
  std::optional<StepPool::Index> next;
  for (std::size_t k = steps.size(); k-- > 0;) {
    pool_.add(steps[k], next);
    next = pool_.find(key_of(steps[k].poses, steps[k].action));
  }
  learn_episode(policy_, steps);
}

}  // namespace rtg
