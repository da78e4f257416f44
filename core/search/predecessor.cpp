#include "core/search/predecessor.hpp"

#include <algorithm>
#include <utility>

#include "core/world/separation.hpp"

namespace rtg::search {

double replay_gap(const Poses& reverse_end, const Poses& replayed_end) {
  double sum = 0.0;
  for (std::size_t k = 0; k < reverse_end.size(); ++k)
    sum += (reverse_end[k].position() - replayed_end[k].position()).norm();
  return sum / static_cast<double>(reverse_end.size());
}

int objects_moved(const Poses& a, const Poses& b) {
  int count = 0;
  for (std::size_t k = 1; k < a.size(); ++k)
    count += (a[k].position() - b[k].position()).norm() > kMoved;
  return count;
}

bool legal_state(const tasks::Task& task, const Poses& poses) {
  return is_finite(poses) && in_arena(poses[0], task.push) &&
         !first_overlap(task.scene, poses).has_value();
}

std::vector<Predecessor> proposals(const tasks::Task& task,
                                   std::span<const reverse::ReverseJob> jobs,
                                   std::span<const reverse::ReverseResult> answers,
                                   SearchStats& stats) {
  std::vector<Predecessor> out;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    for (const Poses& exact : answers[k].predecessors) {
      Poses start = to_single(exact);
      if (!legal_state(task, start)) {
        ++stats.illegal_starts;
        continue;
      }
      const int moved = objects_moved(start, jobs[k].end);
      out.push_back({static_cast<int>(k), jobs[k].action, std::move(start), jobs[k].end, moved});
    }
  }
  return out;
}

std::vector<Predecessor> replay_predecessors(std::vector<Predecessor> predecessors,
                                             const ReplayBatch& replay) {
  std::vector<ReplayJob> pushes;
  for (const Predecessor& p : predecessors) pushes.push_back({p.start, p.action});
  const std::vector<ReplayResult> results = replay(pushes);
  std::vector<Predecessor> out;
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (!results[k].ok) continue;
    Predecessor& p = predecessors[k];
    p.mean_error = replay_gap(p.end, results[k].end);
    for (std::size_t body = 0; body < p.end.size(); ++body)
      p.max_error =
          std::max(p.max_error, (p.end[body].position() - results[k].end[body].position()).norm());
    p.end = results[k].end;
    p.moved = objects_moved(p.start, p.end);
    out.push_back(std::move(p));
  }
  return out;
}

}  // namespace rtg::search
