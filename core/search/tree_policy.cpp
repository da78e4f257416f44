#include "core/search/tree_policy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/reverse/reverse_job.hpp"

namespace rtg {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr float kDistanceWeight = 16.0F;  // actions per metre
constexpr int kBlock = 512;               // entries whose coordinates stay in the first-level cache

}  // namespace

TreePolicy::TreePolicy(const Task& task)
    : metric_(task.scene),
      contact_(task.scene, task.push, task.start[0].theta),
      headings_(task.push.headings),
      coordinate_(static_cast<std::size_t>(metric_.size())) {}

bool TreePolicy::add(const Poses& state, int action, double depth) {
  if (!known_.insert(key_of(state, action)).second) return false;
  std::vector<float> point(coordinate_.size());
  metric_.embed(state, point);
  for (std::size_t k = 0; k < point.size(); ++k) coordinate_[k].push_back(point[k]);
  depth_.push_back(static_cast<float>(depth));
  action_.push_back(action);
  contacts_.resize(contacts_.size() + static_cast<std::size_t>(contact_.size()));
  contact_.describe(state, action,
                    std::span(contacts_).last(static_cast<std::size_t>(contact_.size())));
  return true;
}

void TreePolicy::raise(int first, double price) {
  for (std::size_t k = static_cast<std::size_t>(first); k < depth_.size(); ++k)
    depth_[k] += static_cast<float>(price);
}

/// |c(s_e, a) - c(s, a)|² [m²].
float TreePolicy::contact_gap(std::size_t entry, Seen& query) const {
  const int action = action_[entry];
  const auto size = static_cast<std::size_t>(contact_.size());
  std::vector<float>& there = query.contacts[static_cast<std::size_t>(action)];
  if (there.empty()) {
    there.resize(size);
    contact_.describe(query.state, action, there);
  }
  const float* here = contacts_.data() + entry * size;
  float sum = 0.0F;
  for (std::size_t k = 0; k < size; ++k) sum += (here[k] - there[k]) * (here[k] - there[k]);
  return sum;
}

/// Lowers `best` to the best entry of [begin, end), at most kBlock of them. What the push meets is
/// looked at only where the states are near enough.
void TreePolicy::scan(int begin, int end, Seen& query, std::span<const int> used,
                      Choice& best) const {
  std::array<float, kBlock> gap{}, score{};
  const auto n = static_cast<std::size_t>(end - begin), at = static_cast<std::size_t>(begin);
  for (std::size_t c = 0; c < query.point.size(); ++c) {
    const float* x = coordinate_[c].data() + at;
    for (std::size_t k = 0; k < n; ++k) gap[k] += (x[k] - query.point[c]) * (x[k] - query.point[c]);
  }
  for (std::size_t k = 0; k < n; ++k)
    score[k] = depth_[at + k] + kDistanceWeight * std::sqrt(gap[k]);
  for (const int u : used)
    if (u >= begin && u < end) score[static_cast<std::size_t>(u - begin)] = kNone;
  const auto judge = [&](std::size_t k) {
    if (score[k] > best.score || score[k] == kNone) return;
    const int entry = begin + static_cast<int>(k);
    const float distance = std::sqrt(gap[k] + contact_gap(at + k, query));
    const float whole = depth_[at + k] + kDistanceWeight * distance;
    if (whole < best.score || (whole == best.score && entry < best.entry))
      best = {entry, action_[at + k], whole, distance};
  };
  // The first one spares most of the others.
  const auto least = std::min_element(score.begin(), score.begin() + static_cast<long>(n));
  judge(static_cast<std::size_t>(least - score.begin()));
  for (std::size_t k = 0; k < n; ++k) judge(k);
}

std::vector<TreePolicy::Choice> TreePolicy::choose(std::span<const Query> queries) const {
  std::vector<Choice> best(queries.size(), {-1, 0, kNone, kNone});
  std::vector<Seen> seen;
  for (const Query& q : queries) {
    seen.push_back({q.state, std::vector<float>(coordinate_.size()),
                    std::vector<std::vector<float>>(static_cast<std::size_t>(headings_))});
    metric_.embed(q.state, seen.back().point);
  }
  for (int begin = 0; begin < size(); begin += kBlock)
    for (std::size_t q = 0; q < queries.size(); ++q)
      scan(begin, std::min(begin + kBlock, size()), seen[q], queries[q].used, best[q]);
  return best;
}

}  // namespace rtg
