#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "nodes/jobs/job_dispatcher.hpp"

namespace rtg::jobs {

/// The jobs of one worker that wait or are in work, and its latest answers. A repeated job is not
/// queued again. If its answer is still known, receive() returns the answer. The class does no I/O.
template <class Job, class Answer>
class JobInbox {
 public:
  /// `remembered`: number of latest answers kept.
  explicit JobInbox(std::size_t remembered) : remembered_(remembered) {}

  /// Returns the answer to job `id` if it is still known. Otherwise queues `job`, unless it waits
  /// or is in work already.
  std::optional<Answer> receive(JobId id, Job job) {
    if (const auto found = answers_.find(id); found != answers_.end()) return found->second;
    if (held_.insert(id).second) waiting_.emplace_back(id, std::move(job));
    return std::nullopt;
  }

  /// Removes the next job from the queue and returns it, if any. It is in work until finish().
  std::optional<std::pair<JobId, Job>> take() {
    if (waiting_.empty()) return std::nullopt;
    std::pair<JobId, Job> next = std::move(waiting_.front());
    waiting_.pop_front();
    return next;
  }

  void finish(JobId id, Answer answer) {
    held_.erase(id);
    if (!answers_.emplace(id, std::move(answer)).second) return;
    order_.push_back(id);
    if (order_.size() <= remembered_) return;
    answers_.erase(order_.front());
    order_.pop_front();
  }

  /// Returns the jobs that wait or are in work.
  std::vector<JobId> held() const { return {held_.begin(), held_.end()}; }

 private:
  std::size_t remembered_;
  std::set<JobId> held_;
  std::deque<std::pair<JobId, Job>> waiting_;
  std::map<JobId, Answer> answers_;
  std::deque<JobId> order_;  // keys of answers_, oldest first
};

}  // namespace rtg::jobs
