#include "core/search/plan_search.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/search/state_metric.hpp"

namespace rtg {
namespace {

constexpr std::size_t kBreadth = 4;  // states kept after each action
constexpr int kActions = 4;          // actions tried from each
constexpr int kPatience = 10;        // actions that bring no state nearer to success end a search
constexpr double kTwin = 0.05;       // states so near are the same to the beam [m]

/// What all beams go by.
struct Guide {
  const Task& task;
  const TreePolicy& policy;
  StateMetric metric;
};

/// The beam of one start.
class Beam {
 public:
  explicit Beam(const Poses& start) : nodes_{{start, {}, 0, 0, 0.0F}}, front_{0} {}

  /// Found a plan, or has nothing left to try.
  bool done() const { return front_.empty(); }
  std::vector<Transition> take() { return std::move(plan_); }

  /// Adds the pushes that it wants replayed.
  void propose(const Guide& guide, std::vector<ReplayJob>& pushes) {
    tried_.clear();
    for (const std::size_t k : front_)
      for (const TreePolicy::Choice& c :
           guide.policy.alternatives({nodes_[k].poses, nodes_[k].used}, kActions)) {
        tried_.push_back({k, c.entry});
        pushes.push_back({nodes_[k].poses, c.action});
      }
  }
  std::size_t proposed() const { return tried_.size(); }

  /// Goes on from what its pushes led to.
  void advance(const Guide& guide, std::span<const ReplayJob> pushes,
               std::span<const ReplayResult> results) {
    front_.clear();
    std::vector<Node> next;
    for (std::size_t k = 0; k < pushes.size(); ++k) {
      if (!results[k].ok) continue;
      const Trial& trial = tried_[k];
      Node node{results[k].end, nodes_[trial.parent].used, trial.parent, pushes[k].action, 0.0F};
      if (succeeded(guide.task, node.poses)) return succeed(node);
      node.used.push_back(trial.entry);
      const TreePolicy::Query query{node.poses, node.used};
      node.score = guide.policy.choose({&query, 1}).front().score;
      next.push_back(std::move(node));
    }
    std::ranges::stable_sort(next, {}, &Node::score);
    for (Node& node : next) {
      if (front_.size() == kBreadth) break;
      if (!has_twin(guide.metric, node.poses)) {
        front_.push_back(nodes_.size());
        nodes_.push_back(std::move(node));
      }
    }
    lose_patience();
  }

 private:
  struct Node {
    Poses poses;
    std::vector<int> used;  // entries, as in TreePolicy::Query
    std::size_t parent;     // the first node is its own
    int action;             // that led to it
    float score;
  };
  struct Trial {
    std::size_t parent;
    int entry;
  };

  bool has_twin(const StateMetric& metric, const Poses& poses) const {
    return std::ranges::any_of(
        front_, [&](std::size_t k) { return metric.distance(nodes_[k].poses, poses) < kTwin; });
  }

  void lose_patience() {
    const float score = front_.empty() ? least_ : nodes_[front_.front()].score;
    patience_ = score < least_ ? kPatience : patience_ - 1;
    least_ = std::min(least_, score);
    if (patience_ == 0) front_.clear();
  }

  void succeed(const Node& last) {
    for (const Node* n = &last; n != nodes_.data(); n = &nodes_[n->parent])
      plan_.push_back({nodes_[n->parent].poses, n->action, n->poses, n == &last, Source::kMended});
    std::ranges::reverse(plan_);
    front_.clear();
  }

  std::vector<Node> nodes_;
  std::vector<std::size_t> front_;
  std::vector<Trial> tried_;
  std::vector<Transition> plan_;
  float least_ = std::numeric_limits<float>::infinity();  // score so far
  int patience_ = kPatience;
};

}  // namespace

std::vector<std::vector<Transition>> search_plans(const Task& task, const TreePolicy& policy,
                                                  std::span<const Poses> starts,
                                                  const ReplayBatch& replay, SearchStats& stats) {
  const Guide guide{task, policy, StateMetric(task.scene)};
  std::vector<Beam> beams(starts.begin(), starts.end());
  for (int step = 0; step < task.horizon && !std::ranges::all_of(beams, &Beam::done); ++step) {
    std::vector<ReplayJob> pushes;
    for (Beam& beam : beams) beam.propose(guide, pushes);
    const std::vector<ReplayResult> results = replay(pushes);
    for (const ReplayResult& result : results) stats.count(result);
    std::size_t at = 0;
    for (Beam& beam : beams) {
      const std::size_t count = beam.proposed();
      beam.advance(guide, std::span(pushes).subspan(at, count),
                   std::span(results).subspan(at, count));
      at += count;
    }
  }
  std::vector<std::vector<Transition>> plans;
  for (Beam& beam : beams) plans.push_back(beam.take());
  return plans;
}

}  // namespace rtg
