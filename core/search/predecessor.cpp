#include "core/search/predecessor.hpp"

#include <utility>

#include "core/world/separation.hpp"

namespace rtg::search {

double replay_gap(const Poses& reverse_end, const Poses& replayed_end) {
  double sum = 0.0;
  for (std::size_t k = 0; k < reverse_end.size(); ++k)
    sum += (reverse_end[k].position() - replayed_end[k].position()).norm();
  return sum / static_cast<double>(reverse_end.size());
}

bool has_moved(const Pose& before, const Pose& after) {
  return (before.position() - after.position()).norm() > kMoved;
}

int objects_moved(const Poses& a, const Poses& b) {
  int count = 0;
  for (std::size_t k = 1; k < a.size(); ++k) count += has_moved(a[k], b[k]);
  return count;
}

bool legal_state(const tasks::Task& task, const Poses& poses) {
  return is_finite(poses) && in_arena(poses[0], task.push) &&
         !first_overlap(task.scene, poses).has_value();
}

std::vector<Predecessor> proposals(const tasks::Task& task, const reverse::ReverseJob& job,
                                   const reverse::ReverseResult& answer, int parent,
                                   SearchStats& stats) {
  std::vector<Predecessor> out;
  for (const Poses& exact : answer.predecessors) {
    Poses start = to_single(exact);
    if (!legal_state(task, start)) {
      ++stats.illegal_starts;
      continue;
    }
    out.push_back({parent, job.action, std::move(start), job.end});
  }
  return out;
}

}  // namespace rtg::search
