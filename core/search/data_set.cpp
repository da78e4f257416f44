#include "core/search/data_set.hpp"

#include <algorithm>
#include <vector>

#include "core/reverse/reverse_job.hpp"
#include "core/search/branches.hpp"

namespace rtg {

void DataSet::store(std::span<const Transition> steps) {
  const auto room = static_cast<std::size_t>(config_.transitions - coverage_.transitions());
  const auto per_step = static_cast<std::size_t>(1 + config_.branches);
  const std::size_t fit = std::min((room + per_step - 1) / per_step, steps.size());
  std::vector<Transition> rows = with_branches(task_, steps.first(fit), config_, seed_, replay_);
  std::erase_if(rows, [this](const Transition& t) {
    return !known_.insert(key_of(t.poses, t.action)).second;
  });
  const std::span kept = std::span(rows).first(std::min(room, rows.size()));
  if (kept.empty()) return;
  for (const Transition& t : kept) coverage_.add(t);
  sink_(kept);
}

}  // namespace rtg
