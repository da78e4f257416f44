#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/math/rng.hpp"
#include "core/search/tree_policy.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::testing {

struct Entry {
  Poses state;
  int action = 0;
  double depth = 0.0;
};

inline Entry random_entry(Rng& rng) {
  Entry e{Poses(4), rng.below(48), 1.0 + rng.below(20)};
  for (Pose& p : e.state)
    p = {rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0)};
  return e;
}

/// A tree policy on Gathering beside all its entries, and what it should choose, by brute force.
struct Policy {
  Task task = gathering();
  StateMetric metric{task.scene};
  PushContact contact{task.scene, task.push, 0.0};
  TreePolicy policy{task};
  std::vector<Entry> entries;

  explicit Policy(std::vector<Entry> all) : entries(std::move(all)) {
    for (const Entry& e : entries) policy.add(e.state, e.action, e.depth);
  }

  std::vector<float> met(const Poses& state, int action) const {
    std::vector<float> out(static_cast<std::size_t>(contact.size()));
    contact.describe(state, action, out);
    return out;
  }

  /// `there`: what the entry's action meets in `state`.
  double distance(const Entry& e, const Poses& state, const std::vector<float>& there) const {
    double square = std::pow(metric.distance(e.state, state), 2);
    const std::vector<float> here = met(e.state, e.action);
    for (std::size_t k = 0; k < here.size(); ++k) square += std::pow(here[k] - there[k], 2);
    return std::sqrt(square);
  }

  double distance(int entry, const Poses& state) const {
    const Entry& e = entries[static_cast<std::size_t>(entry)];
    return distance(e, state, met(state, e.action));
  }

  double score(int entry, const Poses& state) const {
    return entries[static_cast<std::size_t>(entry)].depth + 16.0 * distance(entry, state);
  }

  int best(const TreePolicy::Query& query) const {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::vector<float>> there;
    for (int a = 0; a < task.push.headings; ++a) there.push_back(met(query.state, a));
    for (int k = 0; k < policy.size(); ++k) {
      const Entry& e = entries[static_cast<std::size_t>(k)];
      if (std::ranges::count(query.used, k) > 0) continue;
      const double score =
          e.depth + 16.0 * distance(e, query.state, there[static_cast<std::size_t>(e.action)]);
      if (score >= least) continue;
      least = score;
      best = k;
    }
    return best;
  }

  TreePolicy::Choice choose(const TreePolicy::Query& query) const {
    return policy.choose(std::vector{query}).front();
  }
};

inline Policy random_policy(int size) {
  Rng rng(11);
  std::vector<Entry> entries;
  for (int k = 0; k < size; ++k) entries.push_back(random_entry(rng));
  return Policy(std::move(entries));
}

}  // namespace rtg::testing
