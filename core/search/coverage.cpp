#include "core/search/coverage.hpp"

#include "core/search/forward_replay.hpp"

namespace rtg {
namespace {

double share(long part, long whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

bool of_trees(Source source) {
  return source == Source::kStepReplay || source == Source::kChainReplay;
}

}  // namespace

bool in_start_region(const Task& task, const StateMetric& metric, const Poses& poses) {
  const StateMetric::Spread off = metric.spread(poses, task.start);
  return off.position <= kStartRegion && off.angle <= kStartAngle;
}

Coverage::Coverage(const Task& task)
    : task_(task), metric_(task.scene), movers_(movers_of(task.scene)), links_(task.scene) {}

/// Whether two objects moved that no joint connects.
bool Coverage::moves_several(const Transition& t) const {
  std::size_t first = 0;
  for (std::size_t k = 1; k < t.poses.size(); ++k) {
    if ((t.poses[k].position() - t.next[k].position()).norm() <= kMoved) continue;
    if (first != 0 && movers_[k] != first) return true;
    first = movers_[k];
  }
  return false;
}

void Coverage::add(const Transition& t) {
  contacts_ += objects_moved(t.poses, t.next) >= 1;
  multi_body_ += moves_several(t);
  const bool in_region = in_start_region(task_, metric_, t.poses);
  start_region_ += in_region;
  start_region_trees_ += in_region && of_trees(t.source);
  links_.add(t);
}

double Coverage::contact_share() const { return share(contacts_, transitions()); }

double Coverage::multi_body_share() const { return share(multi_body_, transitions()); }

}  // namespace rtg
