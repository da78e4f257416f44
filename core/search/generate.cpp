#include "core/search/generate.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <unordered_set>
#include <utility>

#include "core/search/beam_search.hpp"
#include "core/search/coverage.hpp"
#include "core/search/lost_state.hpp"
#include "core/search/policy_learning.hpp"
#include "core/search/random_episodes.hpp"
#include "core/search/roll_out.hpp"

namespace rtg {
namespace {

// Keys of the independent random streams of one run.
enum Stream : std::uint64_t { kTrees = 1, kProbing, kRollOuts, kNoise, kEvaluation, kProving };

constexpr int kWave = 50;         // roll-outs that run in lockstep
constexpr int kProbes = 50;       // episodes that find a round's target and judge its policy
constexpr double kArrived = 0.5;  // a node so near is at its target [m], as in StateMetric
constexpr double kTurned = 0.5;   // Target::turned where angles matter [m]
constexpr int kMaxBarren = 8;     // rounds or waves without a transition before it gives up

/// Share of the probe starts from which success was reached.
double rating(std::span<const Episode> episodes) {
  const auto solved = std::ranges::count_if(episodes, &Episode::success);
  return static_cast<double>(solved) / kProbes;
}

/// Names a step: what it leads to follows from its start and action.
std::uint64_t key_of_step(const Transition& t) { return key_of(t.poses, t.action); }

/// One run of generate().
class Generation {
 public:
  Generation(const Task& task, const SearchConfig& config, std::uint64_t seed,
             const GenerationSeams& seams)
      : task_(task),
        config_(config),
        seed_(seed),
        seams_(seams),
        metric_(task.scene),
        coverage_(task),
        policy_(task),
        search_(task, config, Rng(seed, kTrees << 32).word()) {}

  GenerationReport run() {
    const auto trees = static_cast<long>(
        static_cast<double>(config_.transitions) * (1.0 - config_.rollout_share) + 0.5);
    for (int barren = 0; stored() < trees && barren < kMaxBarren && !cancelled();)
      barren = grow(trees) ? 0 : barren + 1;
    if (!cancelled()) judge_trees();
    for (int barren = 0; stored() < config_.transitions && barren < kMaxBarren && !cancelled();)
      barren = roll_out() ? 0 : barren + 1;
    return finished_report();
  }

 private:
  long stored() const { return coverage_.transitions(); }
  bool cancelled() const { return seams_.cancelled && seams_.cancelled(); }

  /// Stores the first of them, as far as `limit` transitions in all leave room; returns these.
  std::span<const Transition> store(std::span<const Transition> transitions, long limit) {
    const auto room = static_cast<std::size_t>(std::max(0L, limit - stored()));
    const auto kept = transitions.first(std::min(room, transitions.size()));
    if (kept.empty()) return kept;
    for (const Transition& t : kept) coverage_.add(t);
    seams_.store(kept);
    return kept;
  }

  /// One round: trees grow to where the policy gets lost, or to a jittered start if it does not
  /// (once it solves every probe, also to the angles, for the start region's sake). The policy
  /// takes up what they find if it does better with it. Whether anything was stored.
  bool grow(long limit) {
    const long before = stored();
    const std::size_t known = search_.nodes().size();
    const std::vector<Poses> starts = probe_starts(kProbing);
    const std::vector<Episode> probes = follow(policy_, starts);
    const int proven = policy_.size();
    const double solved = rating(probes);
    grow_towards({lost_state(probes).value_or(starts[0]), solved < 1.0 ? 0.0 : kTurned}, limit);
    replay_chains_from(known, before, limit);
    const auto rate = [&](const TreePolicy& policy) { return rating(follow(policy, starts)); };
    const auto rate_anew = [this](const TreePolicy& policy) {
      return rating(follow(policy, probe_starts(kProving)));
    };
    if (!cancelled()) climb(policy_, proven, solved, rate, rate_anew);
    note_nodes(known);
    ++rounds_;
    return stored() > before;
  }

  /// Layers until the trees have reached the target or patience with those that come no nearer is
  /// over; leaves room for chains.
  void grow_towards(const Target& target, long limit) {
    const long layers =
        limit - static_cast<long>(config_.chain_share * static_cast<double>(limit - stored()));
    const std::size_t known = search_.nodes().size();
    search_.aim(target, seams_.replay, stats_);
    double best = std::numeric_limits<double>::infinity();
    int patience = config_.patience;
    for (int layer = 1; layer <= config_.depth && stored() < layers && !cancelled(); ++layer) {
      const auto growths = search_.grow(seams_.solve, seams_.replay, stats_);
      if (growths.empty()) break;
      store_growths(growths, layers);
      report_progress("round " + std::to_string(rounds_ + 1), layer, config_.depth);
      patience = search_.best() < best ? config_.patience : patience - 1;
      best = std::min(best, search_.best());
      if (patience <= 0 || arrivals(known, target.poses) >= config_.arrivals) break;
    }
  }

  /// Starts of this round's probes.
  std::vector<Poses> probe_starts(Stream stream) const {
    Rng rng(seed_, stream << 32 | static_cast<std::uint64_t>(rounds_));
    return jittered_starts(task_, kProbes, config_.target_jitter, rng);
  }

  /// None of the episodes while there is no policy.
  std::vector<Episode> follow(const TreePolicy& policy, std::span<const Poses> starts) {
    if (policy.size() == 0) return {};
    return run_episodes(task_, policy, {starts}, seams_.replay, stats_);
  }

  /// How many nodes from index `first` on are at the target.
  int arrivals(std::size_t first, const Poses& target) const {
    const auto nodes = search_.nodes().subspan(first);
    return static_cast<int>(std::ranges::count_if(
        nodes, [&](const Node& n) { return metric_.distance(n.poses, target) <= kArrived; }));
  }

  /// Reports the nodes from index `first` on.
  void note_nodes(std::size_t first) {
    for (const Node& n : search_.nodes().subspan(first)) {
      report_.nodes.push_back({n.poses, n.depth, rounds_});
      if (n.depth == 0 || !in_start_region(task_, metric_, n.poses)) continue;
      int& least = report_.start_region_depth;
      least = least < 0 ? n.depth : std::min(least, n.depth);
    }
  }

  /// A state in which the goal holds ends an episode, so nothing starts there. A round that begins
  /// at nodes of another finds some of their steps once more; they are stored once.
  void store_growths(std::span<const BeamSearch::Growth> growths, long limit) {
    std::vector<Transition> fresh;
    for (const BeamSearch::Growth& g : growths) {
      Transition t = step_of(g.candidate);
      if (g.depth > 0 && stored_steps_.insert(key_of_step(t)).second) fresh.push_back(std::move(t));
    }
    const auto kept = store(fresh, limit);
    for (std::size_t k = kept.size(); k < fresh.size(); ++k)
      stored_steps_.erase(key_of_step(fresh[k]));
    for (const BeamSearch::Growth& g : growths) learn(g);
  }

  Transition step_of(const Candidate& c) const {
    return {c.start, c.action, c.end, succeeded(task_, c.end), Source::kStepReplay};
  }

  /// A step that found no room any more is not part of the data that the policy judges; one that
  /// misses serves only if it reaches the goal all the same.
  void learn(const BeamSearch::Growth& growth) {
    const Candidate& c = growth.candidate;
    const auto stored = [&](const Poses& start, int action) {
      return stored_steps_.contains(key_of(start, action));
    };
    if (!stored(c.start, c.action) || !repeatable(c, config_)) return;
    if (c.miss <= config_.gap_tolerance || succeeded(task_, c.end))
      learn_step(policy_, growth, search_.nodes(), stored);
  }

  /// The chains that begin nearest to the start, of nodes from index `first` on, for chain_share of
  /// what the round has stored.
  void replay_chains_from(std::size_t first, long before, long limit) {
    const double share = config_.chain_share;
    const auto wanted =
        static_cast<long>(static_cast<double>(stored() - before) * share / (1.0 - share));
    std::vector<std::pair<double, int>> order;
    const std::span<const Node> nodes = search_.nodes();
    for (std::size_t k = first; k < nodes.size(); ++k)
      if (nodes[k].depth > 1)  // a chain of one step is stored already
        order.emplace_back(metric_.layout_distance(nodes[k].poses, task_.start),
                           static_cast<int>(k));
    std::sort(order.begin(), order.end());
    std::vector<Chain> chains;
    long planned = 0;
    for (const auto& [distance, node] : order) {
      if (planned >= wanted) break;
      chains.push_back(search_.chain(node));
      planned += static_cast<long>(chains.back().actions.size()) - 1;
    }
    const long room = std::min(limit, stored() + wanted);
    for (const auto& steps : replay_chains(task_, chains, seams_.replay, stats_))
      store_chain(steps, room);
  }

  /// Steps that are stored already are left out: the first one of a chain is, bit for bit, the step
  /// that found its far end. The policy learns them all the same.
  void store_chain(std::span<const Transition> steps, long limit) {
    std::vector<Transition> fresh;
    for (const Transition& t : steps)
      if (!stored_steps_.contains(key_of_step(t))) fresh.push_back(t);
    const auto kept = store(fresh, limit);
    for (const Transition& t : kept) stored_steps_.insert(key_of_step(t));
    if (kept.size() == fresh.size()) learn_episode(policy_, steps);
  }

  bool roll_out() {
    const long before = stored();
    const auto key = static_cast<std::uint64_t>(wave_count_);
    Rng rng(seed_, kRollOuts << 32 | key);
    const auto starts = jittered_starts(task_, kWave, config_.rollout_jitter, rng);
    const EpisodePlan plan{starts, config_.rollout_noise, Rng(seed_, kNoise << 32 | key).word()};
    for (const Episode& e : run_episodes(task_, policy_, plan, seams_.replay, stats_))
      learn_episode(policy_, store(e.steps, config_.transitions));
    report_progress("roll-outs", ++wave_count_, 0);
    return stored() > before;
  }

  /// How the policy of the trees does before it learns from roll-outs of its own.
  void judge_trees() {
    Rng rng(seed_, kEvaluation << 32);
    std::vector<Poses> starts;
    for (int k = 0; k < config_.evaluation_starts; ++k)
      starts.push_back(jittered_start(task_, task_.start_jitter, rng));
    const PolicyScore score = evaluate_policy(task_, policy_, starts, seams_.replay, stats_);
    report_.tree_policy_success = score.success;
    report_.tree_policy_length_mean = score.length_mean;
  }

  void report_progress(std::string phase, int layer, int depth) const {
    if (!seams_.progress) return;
    seams_.progress({std::move(phase), layer, depth, stored(), config_.transitions,
                     coverage_.contact_share(), coverage_.start_region()});
  }

  GenerationReport finished_report() {
    report_.transitions = stored();
    report_.contact_share = coverage_.contact_share();
    report_.multi_body_share = coverage_.multi_body_share();
    report_.start_region_transitions = coverage_.start_region();
    report_.start_region_tree_transitions = coverage_.start_region_trees();
    report_.reachable_share = coverage_.reachable_share();
    fill(report_, stats_);
    return std::move(report_);
  }

  const Task& task_;
  SearchConfig config_;
  std::uint64_t seed_;
  const GenerationSeams& seams_;
  StateMetric metric_;
  Coverage coverage_;
  TreePolicy policy_;
  BeamSearch search_;
  std::unordered_set<std::uint64_t> stored_steps_;  // key_of_step()
  SearchStats stats_;
  GenerationReport report_;
  int rounds_ = 0, wave_count_ = 0;
};

}  // namespace

GenerationReport generate(const Task& task, const SearchConfig& config, std::uint64_t seed,
                          const GenerationSeams& seams) {
  const auto start = std::chrono::steady_clock::now();
  GenerationReport report = config.reverse == ReverseMode::kRandom
                                ? random_episodes(task, config, seed, seams)
                                : Generation(task, config, seed, seams).run();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  report.generate_wall_s = wall.count();
  return report;
}

}  // namespace rtg
