#include "core/search/tree_policy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/math/hash.hpp"
#include "core/reverse/reverse_job.hpp"

namespace rtg {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr float kDistanceWeight = 16.0F;  // actions per metre
constexpr float kCell = 0.5F;             // side of a cell [m]
constexpr float kRounding = 1e-5F;        // of a score, relative
constexpr std::size_t kBlock = 8;         // entries that are left out together

/// Squared distance of two points of `size` coordinates; four sums that do not wait for each other.
float square_distance(const float* a, const float* b, std::size_t size) {
  float sums[4] = {0.0F, 0.0F, 0.0F, 0.0F};
  std::size_t k = 0;
  for (; k + 4 <= size; k += 4)
    for (std::size_t m = 0; m < 4; ++m) sums[m] += (a[k + m] - b[k + m]) * (a[k + m] - b[k + m]);
  for (; k < size; ++k) sums[0] += (a[k] - b[k]) * (a[k] - b[k]);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// How far x is from [low, high].
float outside(float x, float low, float high) { return std::max({0.0F, low - x, x - high}); }

/// Squared distance of a point of `size` coordinates from a box.
float square_outside(const float* x, const float* low, const float* high, std::size_t size) {
  float sum = 0.0F;
  for (std::size_t k = 0; k < size; ++k) {
    const float gap = outside(x[k], low[k], high[k]);
    sum += gap * gap;
  }
  return sum;
}

/// Names the square of a robot's position.
std::uint64_t square_of(const float* robot) {
  const auto word = [](float x) {
    return static_cast<std::uint64_t>(std::lround(std::floor(x / kCell)));
  };
  return hashed(hashed(0, word(robot[0])), word(robot[1]));
}

}  // namespace

TreePolicy::TreePolicy(const Task& task)
    : metric_(task.scene),
      contact_(task.scene, task.push, task.start[0].theta),
      headings_(task.push.headings) {}

bool TreePolicy::add(const Poses& state, int action, double depth) {
  const std::uint64_t key = key_of(state, action);
  if (!known_.insert(key).second) return false;
  key_.push_back(key);
  depth_.push_back(static_cast<float>(depth));
  action_.push_back(action);
  const auto coordinates = static_cast<std::size_t>(metric_.size());
  point_.resize(point_.size() + coordinates);
  metric_.embed(state, std::span(point_).last(coordinates));
  const auto numbers = static_cast<std::size_t>(contact_.size());
  contacts_.resize(contacts_.size() + numbers);
  contact_.describe(state, action, std::span(contacts_).last(numbers));
  place(size() - 1);
  return true;
}

/// Puts an entry into its cell. The robot's position leads its embedding.
void TreePolicy::place(int entry) {
  const auto k = static_cast<std::size_t>(entry);
  const auto size = static_cast<std::size_t>(metric_.size());
  const float* robot = point_.data() + k * size;
  const auto [at, fresh] = cell_at_.try_emplace(square_of(robot), cells_.size());
  if (fresh) {
    cells_.emplace_back();
    cells_.back().x = kCell * std::floor(robot[0] / kCell);
    cells_.back().y = kCell * std::floor(robot[1] / kCell);
    cells_.back().least = kNone;
  }
  Cell& cell = cells_[at->second];
  cell.entries.push_back(entry);
  cell.points.insert(cell.points.end(), robot, robot + size);
  enclose(cell, cell.entries.size() - 1);
}

/// Widens the bounds of a cell and its block to those of its entry `at`.
void TreePolicy::enclose(Cell& cell, std::size_t at) const {
  const auto size = static_cast<std::size_t>(metric_.size());
  const std::size_t block = at / kBlock;
  const float* point = cell.points.data() + at * size;
  const float depth = depth_[static_cast<std::size_t>(cell.entries[at])];
  if (at % kBlock == 0) {
    cell.depths.push_back(depth);
    cell.low.insert(cell.low.end(), point, point + size);
    cell.high.insert(cell.high.end(), point, point + size);
  }
  cell.least = std::min(cell.least, depth);
  cell.depths[block] = std::min(cell.depths[block], depth);
  for (std::size_t k = 0; k < size; ++k) {
    cell.low[block * size + k] = std::min(cell.low[block * size + k], point[k]);
    cell.high[block * size + k] = std::max(cell.high[block * size + k], point[k]);
  }
}

void TreePolicy::bound_cells() {
  for (Cell& cell : cells_) {
    cell.least = kNone;
    cell.depths.clear();
    cell.low.clear();
    cell.high.clear();
    for (std::size_t at = 0; at < cell.entries.size(); ++at) enclose(cell, at);
  }
}

void TreePolicy::raise(int first, double price) {
  for (std::size_t k = static_cast<std::size_t>(first); k < depth_.size(); ++k)
    depth_[k] += static_cast<float>(price);
  bound_cells();
}

void TreePolicy::forget(int first) {
  const auto left = static_cast<std::size_t>(first);
  for (std::size_t k = left; k < key_.size(); ++k) known_.erase(key_[k]);
  cut(left);
  for (Cell& cell : cells_) {
    while (!cell.entries.empty() && cell.entries.back() >= first) cell.entries.pop_back();
    cell.points.resize(cell.entries.size() * static_cast<std::size_t>(metric_.size()));
  }
  bound_cells();
}

void TreePolicy::retain(const std::unordered_set<std::uint64_t>& keys) {
  const auto coordinates = static_cast<std::size_t>(metric_.size());
  const auto numbers = static_cast<std::size_t>(contact_.size());
  const auto move = [](std::vector<float>& rows, std::size_t from, std::size_t to, std::size_t n) {
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(from * n), n,
                rows.begin() + static_cast<std::ptrdiff_t>(to * n));
  };
  std::size_t left = 0;
  for (std::size_t k = 0; k < key_.size(); ++k) {
    if (!keys.contains(key_[k])) {
      known_.erase(key_[k]);
      continue;
    }
    key_[left] = key_[k];
    depth_[left] = depth_[k];
    action_[left] = action_[k];
    move(point_, k, left, coordinates);
    move(contacts_, k, left, numbers);
    ++left;
  }
  cells_.clear();
  cell_at_.clear();
  cut(left);
  for (std::size_t k = 0; k < left; ++k) place(static_cast<int>(k));
}

/// Leaves the first `left` entries, but for the cells.
void TreePolicy::cut(std::size_t left) {
  key_.resize(left);
  depth_.resize(left);
  action_.resize(left);
  point_.resize(left * static_cast<std::size_t>(metric_.size()));
  contacts_.resize(left * static_cast<std::size_t>(contact_.size()));
}

/// |c(s_e, a) - c(s, a)|² [m²].
float TreePolicy::contact_gap(std::size_t entry, Seen& seen) const {
  const int action = action_[entry];
  const auto size = static_cast<std::size_t>(contact_.size());
  std::vector<float>& there = seen.contacts[static_cast<std::size_t>(action)];
  if (there.empty()) {
    there.resize(size);
    contact_.describe(seen.query.state, action, there);
  }
  return square_distance(contacts_.data() + entry * size, there.data(), size);
}

/// The best choices so far for different actions, best first, ties to the oldest entry.
class TreePolicy::Shortlist {
 public:
  explicit Shortlist(std::size_t count) : count_(count) { assert(count > 0); }

  /// A score beyond which a choice is of no use.
  float limit() const { return best_.size() < count_ ? kNone : best_.back().score; }

  void offer(const Choice& choice) {
    const auto known = std::ranges::find(best_, choice.action, &Choice::action);
    if (known != best_.end()) {
      if (!before(choice, *known)) return;
      best_.erase(known);
    }
    best_.insert(std::ranges::upper_bound(best_, choice, before), choice);
    if (best_.size() > count_) best_.pop_back();
  }

  std::vector<Choice> take() { return std::move(best_); }

 private:
  static bool before(const Choice& a, const Choice& b) {
    return std::pair(a.score, a.entry) < std::pair(b.score, b.entry);
  }

  std::size_t count_;
  std::vector<Choice> best_;
};

/// Offers the entries of a cell. What the push meets is looked at only where the states are near
/// enough, the states only where their block is.
void TreePolicy::scan(const Cell& cell, Seen& seen, Shortlist& best) const {
  const std::size_t size = seen.point.size();
  for (std::size_t block = 0; block < cell.depths.size(); ++block) {
    if (cell.depths[block] > best.limit()) continue;
    const float gap = square_outside(seen.point.data(), cell.low.data() + block * size,
                                     cell.high.data() + block * size, size);
    const float bound = cell.depths[block] + kDistanceWeight * std::sqrt(gap);
    if (bound * (1.0F - kRounding) > best.limit()) continue;
    const std::size_t end = std::min((block + 1) * kBlock, cell.entries.size());
    for (std::size_t at = block * kBlock; at < end; ++at) offer(cell, at, seen, best);
  }
}

/// Offers one entry of a cell.
void TreePolicy::offer(const Cell& cell, std::size_t at, Seen& seen, Shortlist& best) const {
  const std::size_t size = seen.point.size();
  const int entry = cell.entries[at];
  const auto k = static_cast<std::size_t>(entry);
  if (depth_[k] > best.limit()) return;
  const float gap = square_distance(cell.points.data() + at * size, seen.point.data(), size);
  if (depth_[k] + kDistanceWeight * std::sqrt(gap) > best.limit()) return;
  if (std::ranges::find(seen.query.used, entry) != seen.query.used.end()) return;
  const float distance = std::sqrt(gap + contact_gap(k, seen));
  best.offer({entry, action_[k], depth_[k] + kDistanceWeight * distance, distance});
}

/// The robot's own cell, then others in the order of the least score that an entry of theirs can
/// have, until none can be better than the entries seen.
std::vector<TreePolicy::Choice> TreePolicy::alternatives(const Query& query, int count) const {
  Seen seen{query, std::vector<float>(static_cast<std::size_t>(metric_.size())),
            std::vector<std::vector<float>>(static_cast<std::size_t>(headings_))};
  metric_.embed(query.state, seen.point);
  Shortlist best(static_cast<std::size_t>(count));
  const Cell* own = nullptr;
  if (const auto at = cell_at_.find(square_of(seen.point.data())); at != cell_at_.end()) {
    own = &cells_[at->second];
    scan(*own, seen, best);
  }
  std::vector<std::pair<float, const Cell*>> order;
  for (const Cell& cell : cells_) {
    const float dx = outside(seen.point[0], cell.x, cell.x + kCell);
    const float dy = outside(seen.point[1], cell.y, cell.y + kCell);
    const float bound = cell.least + kDistanceWeight * std::sqrt(dx * dx + dy * dy);
    if (bound * (1.0F - kRounding) <= best.limit() && &cell != own)
      order.emplace_back(bound, &cell);
  }
  const auto by_bound = &std::pair<float, const Cell*>::first;  // few are ever looked at: a heap
  std::ranges::make_heap(order, std::ranges::greater{}, by_bound);
  for (; !order.empty(); order.pop_back()) {
    const auto [bound, cell] = order.front();
    if (bound * (1.0F - kRounding) > best.limit() || bound == kNone) break;
    scan(*cell, seen, best);
    std::ranges::pop_heap(order, std::ranges::greater{}, by_bound);
  }
  return best.take();
}

std::vector<TreePolicy::Choice> TreePolicy::choose(std::span<const Query> queries) const {
  std::vector<Choice> out;
  for (const Query& query : queries) {
    const std::vector<Choice> best = alternatives(query, 1);
    out.push_back(best.empty() ? Choice{-1, 0, kNone, kNone} : best.front());
  }
  return out;
}

}  // namespace rtg
