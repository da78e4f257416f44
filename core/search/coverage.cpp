#include "core/search/coverage.hpp"

#include <unordered_map>

#include "core/search/forward_replay.hpp"

namespace rtg {
namespace {

double share(long part, long whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

bool in_start_region(const Task& task, const StateMetric& metric, const Poses& poses) {
  const StateMetric::Spread off = metric.spread(poses, task.start);
  return off.position <= kStartRegion && off.angle <= kStartAngle;
}

Coverage::Coverage(const Task& task)
    : task_(task), metric_(task.scene), roots_(roots_of(task.scene)) {}

/// Whether two objects moved that no joint connects.
bool Coverage::moves_several(const Transition& t) const {
  std::size_t first = 0;
  for (std::size_t k = 1; k < t.poses.size(); ++k) {
    if ((t.poses[k].position() - t.next[k].position()).norm() <= kMoved) continue;
    if (first != 0 && roots_[k] != first) return true;
    first = roots_[k];
  }
  return false;
}

void Coverage::add(const Transition& t) {
  contacts_ += objects_moved(t.poses, t.next) >= 1;
  multi_body_ += moves_several(t);
  const bool in_region = in_start_region(task_, metric_, t.poses);
  start_region_ += in_region;
  start_region_trees_ += in_region && t.source != Source::kRollOut;
  Link link;
  for (std::size_t g = 0; g < kGrids; ++g) {
    const StateMetric::Cells cells{kLink, kLink, static_cast<double>(g) / kGrids};
    link.from[g] = metric_.cell(t.poses, cells);
    link.to[g] = metric_.cell(t.next, cells);
  }
  link.success = t.success;
  links_.push_back(link);
}

double Coverage::contact_share() const { return share(contacts_, transitions()); }

double Coverage::multi_body_share() const { return share(multi_body_, transitions()); }

double Coverage::reachable_share() const {
  std::array<std::unordered_map<std::uint64_t, std::vector<std::size_t>>, kGrids> ends;
  std::vector<std::size_t> open;
  std::vector<bool> reached(links_.size(), false);
  for (std::size_t k = 0; k < links_.size(); ++k) {
    for (std::size_t g = 0; g < kGrids; ++g) ends[g][links_[k].to[g]].push_back(k);
    if (!links_[k].success) continue;
    reached[k] = true;
    open.push_back(k);
  }
  long count = 0;
  for (; !open.empty(); ++count) {
    const Link& link = links_[open.back()];
    open.pop_back();
    for (std::size_t g = 0; g < kGrids; ++g) {
      const auto before = ends[g].find(link.from[g]);
      if (before == ends[g].end()) continue;
      for (const std::size_t k : before->second)
        if (!reached[k]) {
          reached[k] = true;
          open.push_back(k);
        }
      before->second.clear();
    }
  }
  return share(count, transitions());
}

}  // namespace rtg
