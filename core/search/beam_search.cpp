#include "core/search/beam_search.hpp"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

#include "core/search/beam_selection.hpp"
#include "core/search/goal_roots.hpp"
#include "core/search/ranking.hpp"

namespace rtg {
namespace {

/// Cells of states that differ in the robot only.
constexpr StateMetric::Cells kLayoutCells{1e9, StateMetric::Cells{}.object, 0.5};

constexpr std::uint64_t kTwins = 1;  // key of the random stream of the probe

}  // namespace

BeamSearch::BeamSearch(const Task& task, const SearchConfig& config, std::uint64_t seed)
    : task_(task),
      config_(config),
      metric_(task.scene),
      rng_(seed),
      probe_(task, config, Rng(seed, kTwins).word()) {}

void BeamSearch::aim(const Target& target, int breadth, const ReplayBatch& replay,
                     SearchStats& stats) {
  target_ = target;
  config_.breadth = breadth;
  plant(replay, stats);
  std::vector<BeamEntry> entries;
  for (const Node& n : nodes_)
    entries.push_back({distance_left(n.poses), metric_.cell(n.poses, {}),
                       metric_.cell(n.poses, kLayoutCells), false});
  beam_.clear();
  std::unordered_set<std::uint64_t> none;
  for (const std::size_t k : select_beam(entries, config_, rng_, none))
    beam_.push_back(static_cast<int>(k));
  note_best();
}

void BeamSearch::plant(const ReplayBatch& replay, SearchStats& stats) {
  std::vector<ReplayJob> goals;
  for (Poses& goal : goal_roots(task_, config_, target_, rng_, stats))
    goals.push_back({std::move(goal), kSettle});
  for (const ReplayResult& settled : replay(goals)) {
    if (!stats.count(settled)) continue;
    Poses rest = float_rounded(settled.end);
    if (!legal_state(task_, rest) || !succeeded(task_, rest)) {
      ++stats.unsettled_goals;
      continue;
    }
    if (seen_.insert(metric_.cell(rest, {})).second) nodes_.push_back({std::move(rest), -1, -1, 0});
  }
}

std::vector<ReverseJob> BeamSearch::jobs() const {
  std::vector<ReverseJob> out;
  for (const int node : beam_)
    for (int action = 0; action < task_.push.headings; ++action)
      out.push_back({nodes_[static_cast<std::size_t>(node)].poses, action});
  return out;
}

Score BeamSearch::layer_score() const {
  std::vector<Poses> known;
  if (config_.ranking == Ranking::kNovelty)  // nothing else looks at them
    for (const Node& n : nodes_) known.push_back(n.poses);
  return make_score(config_.ranking, task_, target_, known);
}

/// Leaves out, per node, all but the best `free_moves` of the steps that move no object and, per
/// solve, all but the best `starts` of those that do.
std::vector<Predecessor> BeamSearch::worth_replaying(std::vector<Predecessor> all,
                                                   const Score& score) const {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < all.size(); ++k) order.emplace_back(score(all[k]), k);
  std::sort(order.begin(), order.end());
  std::unordered_map<int, int> idle, pushing;  // kept so far, per node and per solve
  std::vector<bool> dropped(all.size(), false);
  for (const auto& [value, k] : order) {
    const Predecessor& c = all[k];
    dropped[k] = c.moved == 0
                     ? ++idle[c.parent] > config_.free_moves
                     : ++pushing[c.parent * task_.push.headings + c.action] > config_.starts;
  }
  std::vector<Predecessor> out;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (!dropped[k]) out.push_back(std::move(all[k]));
  return out;
}

std::vector<BeamSearch::Growth> BeamSearch::grow(const SolveBatch& solve, const ReplayBatch& replay,
                                                 SearchStats& stats) {
  const std::vector<ReverseJob> asked = jobs();
  const std::vector<ReverseResult> answers = solve(asked);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const std::vector<Poses>& starts = answers[k].starts;
    stats.count(answers[k], !starts.empty() && objects_moved(starts[0], asked[k].end) > 0);
  }
  std::vector<Predecessor> found = proposals(task_, asked, answers, stats);
  for (Predecessor& c : found)
    c.parent = beam_[static_cast<std::size_t>(c.parent / task_.push.headings)];
  const Score score = layer_score();
  std::vector<Predecessor> replayed =
      replay_candidates(task_, worth_replaying(std::move(found), score), replay, stats);
  probe_.measure(replayed, replay, stats);
  std::vector<Growth> out;
  for (Predecessor& c : replayed) {
    stats.gaps.push_back(static_cast<float>(c.gap));
    int depth = nodes_[static_cast<std::size_t>(c.parent)].depth + 1;
    if (succeeded(task_, c.end)) depth = 1;  // by a miss, perhaps
    if (succeeded(task_, c.start)) depth = 0;
    out.push_back({std::move(c), depth});
  }
  advance(out, score);
  return out;
}

/// Chooses the next beam among what replays within the tolerances.
void BeamSearch::advance(std::span<const Growth> growths, const Score& score) {
  std::vector<BeamEntry> entries;
  std::vector<const Growth*> eligible;
  for (const Growth& g : growths) {
    const Predecessor& c = g.candidate;
    if (c.miss > config_.gap_tolerance || !repeatable(c, config_)) continue;
    eligible.push_back(&g);
    entries.push_back(
        {score(c), metric_.cell(c.start, {}), metric_.cell(c.start, kLayoutCells), c.moved > 0});
  }
  beam_.clear();
  for (const std::size_t k : select_beam(entries, config_, rng_, seen_)) {
    const Predecessor& c = eligible[k]->candidate;
    beam_.push_back(static_cast<int>(nodes_.size()));
    nodes_.push_back({c.start, c.parent, c.action, eligible[k]->depth});
  }
  note_best();
}

double BeamSearch::distance_left(const Poses& poses) const {
  return start_distance(task_, metric_, poses, target_);
}

void BeamSearch::note_best() {
  best_ = std::numeric_limits<double>::infinity();
  for (const int node : beam_)
    best_ = std::min(best_, distance_left(nodes_[static_cast<std::size_t>(node)].poses));
}

Chain BeamSearch::chain(int node) const {
  Chain out{nodes_[static_cast<std::size_t>(node)].poses, {}};
  for (int k = node, left = nodes_[static_cast<std::size_t>(node)].depth; left > 0; --left) {
    out.actions.push_back(nodes_[static_cast<std::size_t>(k)].action);
    k = nodes_[static_cast<std::size_t>(k)].parent;
  }
  return out;
}

}  // namespace rtg
