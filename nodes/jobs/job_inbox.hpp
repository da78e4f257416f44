#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "nodes/jobs/job_dispatcher.hpp"

namespace rtg::jobs {

/// A worker's memory of its jobs, free of I/O: what waits, what is being worked on, and the last
/// answers, so that a job said twice is neither done twice at once nor forgotten.
template <class Job, class Answer>
class JobInbox {
 public:
  /// `remembered`: answers kept for repeated questions.
  explicit JobInbox(std::size_t remembered) : remembered_(remembered) {}

  /// The answer if the job was done before; otherwise the job waits for its turn, once.
  std::optional<Answer> receive(JobId id, Job job) {
    if (const auto found = answers_.find(id); found != answers_.end()) return found->second;
    if (held_.insert(id).second) waiting_.emplace_back(id, std::move(job));
    return std::nullopt;
  }

  /// The job to work on next, if any; it is held until finish().
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

  /// Jobs that wait or are being worked on.
  std::vector<JobId> held() const { return {held_.begin(), held_.end()}; }

 private:
  std::size_t remembered_;
  std::set<JobId> held_;
  std::deque<std::pair<JobId, Job>> waiting_;
  std::map<JobId, Answer> answers_;
  std::deque<JobId> order_;  // of answers, oldest first
};

}  // namespace rtg::jobs
