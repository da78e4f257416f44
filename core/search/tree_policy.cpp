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
    : metric_(task.scene), coordinate_(static_cast<std::size_t>(metric_.size())) {}

bool TreePolicy::add(const Poses& state, int action, double depth) {
  if (!known_.insert(key_of(state, action)).second) return false;
  std::vector<float> point(coordinate_.size());
  metric_.embed(state, point);
  for (std::size_t k = 0; k < point.size(); ++k) coordinate_[k].push_back(point[k]);
  depth_.push_back(static_cast<float>(depth));
  action_.push_back(action);
  return true;
}

void TreePolicy::raise(int first, double price) {
  for (std::size_t k = static_cast<std::size_t>(first); k < depth_.size(); ++k)
    depth_[k] += static_cast<float>(price);
}

/// Lowers `best` to the best entry of [begin, end), at most kBlock of them.
void TreePolicy::scan(int begin, int end, std::span<const float> point, std::span<const int> used,
                      Choice& best) const {
  std::array<float, kBlock> score{};
  const auto n = static_cast<std::size_t>(end - begin), at = static_cast<std::size_t>(begin);
  for (std::size_t c = 0; c < point.size(); ++c) {
    const float* x = coordinate_[c].data() + at;
    for (std::size_t k = 0; k < n; ++k) score[k] += (x[k] - point[c]) * (x[k] - point[c]);
  }
  for (std::size_t k = 0; k < n; ++k)
    score[k] = depth_[at + k] + kDistanceWeight * std::sqrt(score[k]);
  for (const int u : used)
    if (u >= begin && u < end) score[static_cast<std::size_t>(u - begin)] = kNone;
  const auto least = std::min_element(score.begin(), score.begin() + static_cast<long>(n));
  if (*least >= best.score) return;
  const int entry = begin + static_cast<int>(least - score.begin());
  const auto e = static_cast<std::size_t>(entry);
  best = {entry, action_[e], *least, (*least - depth_[e]) / kDistanceWeight};
}

std::vector<TreePolicy::Choice> TreePolicy::choose(std::span<const Query> queries) const {
  std::vector<Choice> best(queries.size(), {-1, 0, kNone, kNone});
  std::vector<std::vector<float>> points(queries.size(), std::vector<float>(coordinate_.size()));
  for (std::size_t q = 0; q < queries.size(); ++q) metric_.embed(queries[q].state, points[q]);
  for (int begin = 0; begin < size(); begin += kBlock)
    for (std::size_t q = 0; q < queries.size(); ++q)
      scan(begin, std::min(begin + kBlock, size()), points[q], queries[q].used, best[q]);
  return best;
}

}  // namespace rtg
