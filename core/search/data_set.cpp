#include "core/search/data_set.hpp"

#include <algorithm>
#include <vector>

#include "core/reverse/problem/reverse_job.hpp"
#include "core/search/branches.hpp"

namespace rtg::search {

void DataSet::begin_shard(int count) {
  left_ = count;
  stored_ = 0;
  known_.clear();
}

void DataSet::store(std::span<const Transition> steps, const ReplayBatch& replay) {
  const auto room = static_cast<std::size_t>(left_);
  const auto per_step = static_cast<std::size_t>(1 + config_.branches);
  const auto is_new = [this](const Transition& t) {
    return known_.insert(reverse::key_of(t.poses, t.action)).second;
  };
  std::vector<Transition> fresh;
  for (const Transition& step : steps)
    if (fresh.size() * per_step < room && is_new(step)) fresh.push_back(step);
  std::vector<Transition> rows = with_branches(task_, fresh, config_, seed_, replay);
  std::erase_if(rows,
                [&](const Transition& t) { return t.source == Source::kBranch && !is_new(t); });
  const std::span kept = std::span(rows).first(std::min(room, rows.size()));
  if (kept.empty()) return;
  for (const Transition& t : kept) coverage_.add(t);
  left_ -= static_cast<long>(kept.size());
  stored_ += static_cast<long>(kept.size());
  sink_(kept);
}

}  // namespace rtg::search
