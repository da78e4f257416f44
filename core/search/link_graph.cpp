#include "core/search/link_graph.hpp"

#include <cmath>

#include "core/math/hash.hpp"

namespace rtg {
namespace {

/// Names the square that is (dx, dy) squares from that of a robot.
std::uint64_t square(const Pose& robot, int dx, int dy) {
  const auto word = [](double x, int by) {
    return static_cast<std::uint64_t>(std::llround(std::floor(x / LinkGraph::kLink)) + by);
  };
  return hashed(hashed(0, word(robot.x, dx)), word(robot.y, dy));
}

}  // namespace

void LinkGraph::add(const Transition& t) { links_.push_back({t.poses, t.next, t.success}); }

/// Moves the links that `link` follows from `ends` to `open`.
void LinkGraph::take_before(const Link& link, Squares& ends, std::vector<std::size_t>& open) const {
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) {
      const auto found = ends.find(square(link.from[0], dx, dy));
      if (found == ends.end()) continue;
      std::erase_if(found->second, [&](std::size_t k) {
        if (!metric_.within(links_[k].to, link.from, kLink)) return false;
        open.push_back(k);
        return true;
      });
    }
}

double LinkGraph::reachable_share() const {
  Squares ends;
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < links_.size(); ++k)
    if (links_[k].success)
      open.push_back(k);
    else
      ends[square(links_[k].to[0], 0, 0)].push_back(k);
  std::size_t count = 0;
  for (; !open.empty(); ++count) {
    const Link& link = links_[open.back()];
    open.pop_back();
    take_before(link, ends, open);
  }
  return links_.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(links_.size());
}

}  // namespace rtg
