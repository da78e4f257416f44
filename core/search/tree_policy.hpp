#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/search/push_contact.hpp"
#include "core/search/state_metric.hpp"
#include "core/tasks/task.hpp"

namespace rtg {

/// Nearest-node policy over stored transitions: of all entries (state, action, depth) it takes the
/// action of the one with the least
///
///   score = depth + 16 / m · √(|s_e - s|² + |c(s_e, a) - c(s, a)|²),
///
/// s the current state and (s_e, a) those of the entry, |s_e - s| their distance as in StateMetric,
/// c what the push meets there (PushContact): the same action from a state that is near may hit an
/// object that it only brushes in the other. depth is the number of actions from there to success
/// and a price for those that are hard to repeat (raise()). It learns nothing but
/// these prices and which rounds to leave out, so its success rate judges the data.
class TreePolicy {
 public:
  explicit TreePolicy(const Task& task);

  /// An action that led from `state` to where success is `depth - 1` actions away; whether it is
  /// new: of a state and action the first entry stays.
  bool add(const Poses& state, int action, double depth);

  /// Adds `price`, also a negative one, to the depth of the entries from index `first` on.
  void raise(int first, double price);

  /// Forgets the entries from index `first` on.
  void forget(int first);

  /// Forgets all entries but those with these keys.
  void retain(const std::unordered_set<std::uint64_t>& keys);

  /// key_of() an entry's state and action.
  std::uint64_t key(int entry) const { return key_[static_cast<std::size_t>(entry)]; }

  /// Number of entries.
  int size() const { return static_cast<int>(depth_.size()); }

  /// Where an episode is and the entries it has used; an entry is used once per episode, or a
  /// deterministic policy would go round in circles.
  struct Query {
    Poses state;
    std::vector<int> used;
  };
  struct Choice {
    int entry = -1;  // -1: there is no entry left
    int action = 0;
    float score = 0.0F;
    float distance = 0.0F;  // from the entry, the root in the score [m]
  };
  /// One choice per query, ties to the oldest entry.
  std::vector<Choice> choose(std::span<const Query> queries) const;

  /// The best choices for different actions, best first, at most `count`; none without an entry.
  std::vector<Choice> alternatives(const Query& query, int count) const;

 private:
  /// Entries whose robot is in one square of the plane, in blocks of kBlock: entries that came one
  /// after the other are of one tree or episode, so that a block's embeddings are alike.
  struct Cell {
    float x = 0.0F, y = 0.0F;   // lower corner [m]
    float least = 0.0F;         // depth of them all at least
    std::vector<int> entries;   // ascending
    std::vector<float> points;  // their embeddings once more, side by side: scanning is all loads
    std::vector<float> depths;  // of a block at least
    std::vector<float> low, high;  // of a block: the box around its embeddings
  };
  class Shortlist;

  /// A query in the coordinates of the entries.
  struct Seen {
    const Query& query;
    std::vector<float> point;                  // embedding
    std::vector<std::vector<float>> contacts;  // per action, empty until it is needed
  };
  void scan(const Cell& cell, Seen& seen, Shortlist& best) const;
  void offer(const Cell& cell, std::size_t at, Seen& seen, Shortlist& best) const;
  float contact_gap(std::size_t entry, Seen& seen) const;
  void cut(std::size_t left);
  void place(int entry);
  void enclose(Cell& cell, std::size_t at) const;
  void bound_cells();

  StateMetric metric_;
  PushContact contact_;
  int headings_;
  std::vector<float> point_;     // embeddings of the entries, one after the other
  std::vector<float> contacts_;  // PushContact of them, likewise
  std::vector<float> depth_;
  std::vector<int> action_;
  std::vector<std::uint64_t> key_;           // key_of() of state and action
  std::unordered_set<std::uint64_t> known_;  // the same
  std::vector<Cell> cells_;
  std::unordered_map<std::uint64_t, std::size_t> cell_at_;  // index of the square's cell
};

}  // namespace rtg
