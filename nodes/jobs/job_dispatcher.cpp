#include "nodes/jobs/job_dispatcher.hpp"

#include <algorithm>
#include <utility>

namespace rtg::jobs {

void JobDispatcher::submit(std::span<const JobId> jobs) {
  jobs_.clear();
  queue_.clear();
  for (auto& [id, worker] : workers_) worker.leases.clear();
  for (const JobId id : jobs)
    if (jobs_.try_emplace(id).second) queue_.push_back(id);
  open_ = static_cast<long>(jobs_.size());
}

void JobDispatcher::on_beat(const Beat& beat, bus::Seconds now) {
  Worker& worker = workers_[beat.worker];
  worker.beat = now;
  worker.capacity = beat.capacity;
  worker.held = {beat.held.begin(), beat.held.end()};
  std::erase_if(worker.stuck, [&](JobId id) { return !worker.held.contains(id); });
}

JobDispatcher::Verdict JobDispatcher::on_result(JobId id) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return Verdict::kUnknown;
  Job& job = found->second;
  if (job.state == State::kDone || job.state == State::kPoison) return Verdict::kDuplicate;
  if (job.state == State::kLeased) workers_[job.worker].leases.erase(id);
  job.state = State::kDone;
  --open_;
  return Verdict::kAccepted;
}

std::vector<JobDispatcher::Send> JobDispatcher::due(bus::Seconds now) {
  std::vector<Send> sends;
  leave_out_sleep(now);
  drop_silent_workers(now);
  give_up_stuck_workers(now);
  resend_unheard(now, sends);
  hand_out(now, sends);
  return sends;
}

std::vector<JobId> JobDispatcher::poisoned() const {
  std::vector<JobId> ids;
  for (const auto& [id, job] : jobs_)
    if (job.state == State::kPoison) ids.push_back(id);
  return ids;
}

void JobDispatcher::leave_out_sleep(bus::Seconds now) {
  const bus::Seconds slept = now - std::exchange(last_due_, now);
  if (slept <= limits_.silence / 2.0) return;
  const auto later = [&](bus::Seconds& time) { time = std::min(time + slept, now); };
  for (auto& [id, worker] : workers_) later(worker.beat);
  for (auto& [id, job] : jobs_) {
    later(job.leased);
    later(job.sent);
  }
}

void JobDispatcher::drop_silent_workers(bus::Seconds now) {
  std::erase_if(workers_, [&](const auto& entry) {
    const Worker& worker = entry.second;
    if (now - worker.beat <= limits_.silence) return false;
    for (const JobId id : worker.leases) take_back(id, true);
    return true;
  });
}

void JobDispatcher::give_up_stuck_workers(bus::Seconds now) {
  for (auto& [worker_id, worker] : workers_) {
    const auto has_run_out = [&](JobId id) { return now - jobs_.at(id).leased > limits_.lease; };
    if (std::ranges::none_of(worker.leases, has_run_out)) continue;
    for (const JobId id : worker.leases) {
      // A job that the worker does not hold never reached it and cannot have stopped it.
      if (worker.held.contains(id) && has_run_out(id)) worker.stuck.insert(id);
      take_back(id, worker.held.contains(id));
    }
    worker.leases.clear();
  }
}

void JobDispatcher::take_back(JobId id, bool worker_lost) {
  Job& job = jobs_.at(id);
  ++reissued_;
  job.lost_workers += worker_lost;
  if (job.lost_workers >= limits_.poison) {
    job.state = State::kPoison;
    --open_;
  } else {
    job.state = State::kNew;
    queue_.push_front(id);
  }
}

void JobDispatcher::resend_unheard(bus::Seconds now, std::vector<Send>& sends) {
  for (auto& [worker_id, worker] : workers_)
    for (const JobId id : worker.leases) {
      Job& job = jobs_.at(id);
      // An earlier beat may have crossed the job on the way, so it proves nothing.
      if (worker.held.contains(id) || worker.beat - job.sent < limits_.resend) continue;
      job.sent = now;
      ++resent_;
      sends.push_back({worker_id, id, ++job.attempt});
    }
}

/// Returns how much room `worker` has for the next job. 0: it must not get that job. `suspect`: a
/// worker that had the job was lost. A suspect job must be the only job of its worker, so only an
/// idle worker has room for it, its whole capacity.
int JobDispatcher::room(const Worker& worker, bool suspect) const {
  if (!worker.stuck.empty()) return 0;
  const int leases = static_cast<int>(worker.leases.size());
  if (suspect) return leases == 0 ? worker.capacity : 0;
  if (leases == 1 && jobs_.at(*worker.leases.begin()).lost_workers > 0) return 0;
  return worker.capacity - leases;
}

void JobDispatcher::hand_out(bus::Seconds now, std::vector<Send>& sends) {
  while (!queue_.empty()) {
    const JobId id = queue_.front();
    Job& job = jobs_.at(id);
    if (job.state != State::kNew) {
      queue_.pop_front();
      continue;
    }
    auto freest = workers_.end();
    int most = 0;
    for (auto it = workers_.begin(); it != workers_.end(); ++it) {
      const int free = room(it->second, job.lost_workers > 0);
      if (free > most) freest = it, most = free;
    }
    if (freest == workers_.end()) return;
    queue_.pop_front();
    freest->second.leases.insert(id);
    job = {State::kLeased, freest->first, now, now, job.attempt + 1, job.lost_workers};
    sends.push_back({freest->first, id, job.attempt});
  }
}

}  // namespace rtg::jobs
