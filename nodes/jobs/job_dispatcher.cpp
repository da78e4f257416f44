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
  worker.number = beat.number;
  worker.capacity = beat.capacity;
  worker.held = {beat.held.begin(), beat.held.end()};
  std::erase_if(worker.stuck, [&](JobId id) { return !worker.held.contains(id); });
}

JobDispatcher::Verdict JobDispatcher::on_result(JobId id, bus::Seconds now) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return Verdict::kUnknown;
  const Job& job = found->second;
  if (job.state == State::kDone || job.state == State::kPoison) return Verdict::kDuplicate;
  if (!job.leases.empty()) times_.add(now - job.leases.front().given);
  end(id, State::kDone);
  return Verdict::kAccepted;
}

std::vector<JobDispatcher::Send> JobDispatcher::due(bus::Seconds now) {
  std::vector<Send> sends;
  leave_out_sleep(now);
  bury_dead_workers(now);
  give_up_stuck_workers(now);
  resend_unheard(now, sends);
  hand_out_new(now, sends);
  hand_out_late(now, sends);
  return sends;
}

int JobDispatcher::workers() const {
  return static_cast<int>(std::ranges::count_if(
      workers_, [this](const auto& entry) { return !is_silent(entry.second, last_due_); }));
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
  for (auto& [id, job] : jobs_)
    for (Lease& lease : job.leases) {
      later(lease.given);
      later(lease.sent);
    }
}

bool JobDispatcher::is_silent(const Worker& worker, bus::Seconds now) const {
  return now - worker.beat > limits_.silence;
}

/// Returns whether a worker with the number of `worker` has been heard since `worker` was.
bool JobDispatcher::has_successor(const Worker& worker) const {
  return std::ranges::any_of(workers_, [&](const auto& entry) {
    return entry.second.number == worker.number && entry.second.beat > worker.beat;
  });
}

void JobDispatcher::bury_dead_workers(bus::Seconds now) {
  for (auto it = workers_.begin(); it != workers_.end();) {
    Worker& worker = it->second;
    const bool dead =
        is_silent(worker, now) && (has_successor(worker) || now - worker.beat > limits_.lease);
    if (dead) end_leases(it->first, worker);
    it = dead ? workers_.erase(it) : std::next(it);
  }
}

void JobDispatcher::give_up_stuck_workers(bus::Seconds now) {
  for (auto& [worker_id, worker] : workers_) {
    const auto has_run_out = [&, id = worker_id](JobId job) {
      const auto& leases = jobs_.at(job).leases;
      return now - std::ranges::find(leases, id, &Lease::worker)->given > limits_.lease;
    };
    if (std::ranges::none_of(worker.leases, has_run_out)) continue;
    for (const JobId id : worker.leases)
      if (worker.held.contains(id) && has_run_out(id)) worker.stuck.insert(id);
    end_leases(worker_id, worker);
  }
}

/// Takes all jobs back from a lost worker. Only those that it held are suspect: one that never
/// reached it cannot have killed it.
void JobDispatcher::end_leases(WorkerId worker_id, Worker& worker) {
  for (const JobId id : std::exchange(worker.leases, {})) {
    Job& job = jobs_.at(id);
    std::erase_if(job.leases, [&](const Lease& lease) { return lease.worker == worker_id; });
    job.lost_workers += worker.held.contains(id);
    if (job.lost_workers >= limits_.poison) {
      end(id, State::kPoison);
    } else if (job.leases.empty()) {
      job.state = State::kNew;
      queue_.push_front(id);
    }
  }
}

void JobDispatcher::end(JobId id, State state) {
  Job& job = jobs_.at(id);
  for (const Lease& lease : std::exchange(job.leases, {}))
    workers_.at(lease.worker).leases.erase(id);
  job.state = state;
  --open_;
}

void JobDispatcher::resend_unheard(bus::Seconds now, std::vector<Send>& sends) {
  for (const auto& [worker_id, worker] : workers_)
    for (const JobId id : worker.leases) {
      Job& job = jobs_.at(id);
      Lease& lease = *std::ranges::find(job.leases, worker_id, &Lease::worker);
      // An earlier beat may have crossed the job on the way, so it proves nothing.
      if (worker.held.contains(id) || worker.beat - lease.sent < limits_.resend) continue;
      lease.sent = now;
      ++resent_;
      sends.push_back({worker_id, id, ++job.attempt});
    }
}

/// Returns how much room `worker` has for the next job. 0: it must not get that job. `suspect`: a
/// worker that had the job was lost. A suspect job must be the only job of its worker, so only an
/// idle worker has room for it, its whole capacity.
int JobDispatcher::room(const Worker& worker, bool suspect, bus::Seconds now) const {
  if (!worker.stuck.empty() || is_silent(worker, now)) return 0;
  const int leases = static_cast<int>(worker.leases.size());
  if (suspect) return leases == 0 ? worker.capacity : 0;
  if (leases == 1 && jobs_.at(*worker.leases.begin()).lost_workers > 0) return 0;
  return worker.capacity - leases;
}

/// Gives a job to the worker with most room, or to an idle one. Returns whether there is such a
/// worker that has not got it.
bool JobDispatcher::give(JobId id, bool to_idle, bus::Seconds now, std::vector<Send>& sends) {
  Job& job = jobs_.at(id);
  auto freest = workers_.end();
  int most = 0;
  for (auto it = workers_.begin(); it != workers_.end(); ++it) {
    if (it->second.leases.contains(id) || (to_idle && !it->second.leases.empty())) continue;
    const int free = room(it->second, job.lost_workers > 0, now);
    if (free > most) freest = it, most = free;
  }
  if (freest == workers_.end()) return false;
  freest->second.leases.insert(id);
  job.state = State::kLeased;
  job.leases.push_back({freest->first, now, now});
  if (++job.attempt > 1) ++reissued_;
  sends.push_back({freest->first, id, job.attempt});
  return true;
}

void JobDispatcher::hand_out_new(bus::Seconds now, std::vector<Send>& sends) {
  while (!queue_.empty()) {
    const JobId id = queue_.front();
    if (jobs_.at(id).state == State::kNew && !give(id, false, now, sends)) return;
    queue_.pop_front();
  }
}

void JobDispatcher::hand_out_late(bus::Seconds now, std::vector<Send>& sends) {
  std::vector<JobId> late;
  for (const auto& [worker_id, worker] : workers_)
    for (const JobId id : worker.leases)
      if (is_late(jobs_.at(id), now)) late.push_back(id);
  for (const JobId id : late)
    if (is_late(jobs_.at(id), now)) {  // not given to another one meanwhile
      const auto silent = [&](const Lease& lease) {
        return is_silent(workers_.at(lease.worker), now);
      };
      give(id, !std::ranges::all_of(jobs_.at(id).leases, silent), now, sends);
    }
}

bool JobDispatcher::is_late(const Job& job, bus::Seconds now) const {
  const auto silent = [&](const Lease& lease) { return is_silent(workers_.at(lease.worker), now); };
  if (std::ranges::all_of(job.leases, silent)) return true;
  const auto median = times_.median();
  return median && job.leases.size() == 1 && job.lost_workers == 0 &&
         now - job.leases.front().given > std::max(limits_.late * *median, limits_.resend);
}

}  // namespace rtg::jobs
