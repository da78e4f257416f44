#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "nodes/bus/seconds.hpp"

namespace rtg::jobs {

/// Id of a unit of work: a hash of its content, so that equal units have equal ids.
using JobId = std::int64_t;
/// Id of one start of a worker process.
using WorkerId = std::int64_t;

/// Assigns jobs to workers that may die, over a network that loses, duplicates and reorders
/// messages. The states of a job are NEW -> LEASED -> DONE or POISON. The class does no I/O: the
/// caller passes in events and the time, and sends the messages that due() returns.
///
/// Workers announce their capacity and the jobs that they hold. due() resends a leased job that its
/// worker does not hold. A worker is lost when it falls silent, or when a lease expires. A worker
/// that is alive and still holds a job with an expired lease is stuck: it gets no more jobs until
/// it releases that job. The leases of a lost worker go to other workers. A job that may have
/// killed a worker is then the only job of its new worker, so that one deadly job does not make
/// other jobs look deadly. A job that `poison` lost workers held is poison and is given up. A
/// result is accepted by its job id, whichever worker and attempt it comes from.
class JobDispatcher {
 public:
  struct Limits {
    bus::Seconds silence = 2.0;  // a worker without a beat for this long is lost
    bus::Seconds resend = 0.1;   // a beat this long after sending should list the job
    bus::Seconds lease = 300.0;  // limit from lease to result, some hundred times the usual time
    int poison = 3;              // number of lost workers after which a job is given up
  };
  struct Send {
    WorkerId worker = 0;
    JobId job = 0;
    int attempt = 0;

    bool operator==(const Send&) const = default;
  };
  struct Beat {
    WorkerId worker = 0;
    int capacity = 0;
    std::span<const JobId> held;
  };
  enum class Verdict { kAccepted, kDuplicate, kUnknown };

  JobDispatcher() = default;
  explicit JobDispatcher(const Limits& limits) : limits_(limits) {}

  /// Replaces the set of jobs. `jobs` are handed out in this order; equal ids are one job.
  void submit(std::span<const JobId> jobs);

  void on_beat(const Beat& beat, bus::Seconds now);
  Verdict on_result(JobId job);

  /// Returns the messages that have to be sent now. Must be called after every event and a few
  /// times a second. If more than `silence` / 2 passed without a call, this process was suspended
  /// and received nothing; the dispatcher then excludes that time from all timeouts.
  std::vector<Send> due(bus::Seconds now);

  bool finished() const { return open_ == 0; }
  long open() const { return open_; }
  int workers() const { return static_cast<int>(workers_.size()); }
  std::vector<JobId> poisoned() const;
  long reissued() const { return reissued_; }  // leases taken back from lost workers
  long resent() const { return resent_; }      // messages sent again

 private:
  enum class State { kNew, kLeased, kDone, kPoison };
  struct Job {
    State state = State::kNew;
    WorkerId worker = 0;
    bus::Seconds leased = 0.0, sent = 0.0;
    int attempt = 0, victims = 0;
  };
  struct Worker {
    bus::Seconds beat = 0.0;
    int capacity = 0;
    std::set<JobId> held;    // as of its last beat
    std::set<JobId> leases;  // jobs leased to it
    std::set<JobId> stuck;   // jobs that it holds although their lease has expired
  };

  void leave_out_sleep(bus::Seconds now);
  void drop_silent_workers(bus::Seconds now);
  void give_up_stuck_workers(bus::Seconds now);
  void take_back(JobId id, bool victim);
  void resend_unheard(bus::Seconds now, std::vector<Send>& sends);
  int room(const Worker& worker, bool suspect) const;
  void hand_out(bus::Seconds now, std::vector<Send>& sends);

  Limits limits_;
  std::map<JobId, Job> jobs_;
  std::deque<JobId> queue_;  // jobs in state NEW, and ids that have since been answered
  std::map<WorkerId, Worker> workers_;
  long open_ = 0, reissued_ = 0, resent_ = 0;
  bus::Seconds last_due_ = std::numeric_limits<bus::Seconds>::infinity();
};

}  // namespace rtg::jobs
