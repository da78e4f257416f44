#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "nodes/bus/seconds.hpp"
#include "nodes/jobs/recent_times.hpp"

namespace rtg::jobs {

/// Id of a job: a hash of its content, so that equal jobs have equal ids.
using JobId = std::int64_t;
/// Id of a worker process, drawn at random when it starts. A restarted worker has a new one.
using WorkerId = std::int64_t;

/// Assigns jobs to worker processes that may die. The network between them loses, duplicates and
/// reorders messages. A job here is one unit of work, as in UnitLimit. The class does no I/O: the
/// caller passes in events and the time, and sends the messages that due() returns.
///
/// A job is NEW, then LEASED (given to a worker), then DONE or POISON (given up):
///
///  - Each worker announces in beats its capacity and the jobs that it holds.
///  - due() sends a leased job again if its worker does not announce it.
///  - A worker without a beat for `silence` may be dead, frozen or out of reach. It keeps its jobs,
///    but they go to another one, too. Whoever answers first counts.
///  - So does a job that takes `late` times as long as the median, once a worker is idle.
///  - A worker is lost if it is silent and another one with its number has come in its place, or if
///    it has held a job for longer than the `lease`, silent or not. Nothing else is a reason to
///    suspect a job: a machine may freeze, and others may kill.
///  - A worker that is not silent and still holds a job after the lease is stuck. It gets no more
///    jobs until it releases that job.
///  - A job that a lost worker held may have killed it. The next worker gets that job alone, so
///  that
///    no other job comes under suspicion.
///  - A job is POISON once `poison` workers that held it were lost.
///  - A result counts by its job id, whichever worker and attempt it comes from.
class JobDispatcher {
 public:
  struct Limits {
    bus::Seconds silence = 2.0;  // longest time between two beats of a worker that works [s]
    bus::Seconds resend = 0.02;  // a beat this long after sending a job should list it [s]
    // Longest legal time to a result [s]. A unit takes milliseconds, with the preset paper minutes.
    bus::Seconds lease = 300.0;
    int poison = 5;     // number of lost workers after which a job is given up
    double late = 3.0;  // [median of the times from giving a job to its result]
  };
  struct Send {
    WorkerId worker = 0;
    JobId job = 0;
    int attempt = 0;

    bool operator==(const Send&) const = default;
  };
  struct Beat {
    WorkerId worker = 0;
    int number = 0;  // a worker that is started again has that of the one before
    int capacity = 0;
    std::span<const JobId> held;
  };
  enum class Verdict { kAccepted, kDuplicate, kUnknown };

  JobDispatcher() = default;
  explicit JobDispatcher(const Limits& limits) : limits_(limits) {}

  /// Replaces all jobs by `jobs`, which are assigned in this order. Equal ids count as one job.
  void submit(std::span<const JobId> jobs);

  void on_beat(const Beat& beat, bus::Seconds now);
  Verdict on_result(JobId job, bus::Seconds now);

  /// Returns the messages to send now. Must be called after every event and a few times a second. A
  /// longer pause than `silence` / 2 between calls means that this process was suspended. Timeouts
  /// do not count such a pause.
  std::vector<Send> due(bus::Seconds now);

  bool finished() const { return open_ == 0; }
  long open() const { return open_; }
  /// Returns the number of workers that are not silent.
  int workers() const;
  std::vector<JobId> poisoned() const;
  long reissued() const { return reissued_; }  // jobs given to a further worker
  long resent() const { return resent_; }      // messages sent again

 private:
  enum class State { kNew, kLeased, kDone, kPoison };
  struct Lease {
    WorkerId worker = 0;
    bus::Seconds given = 0.0, sent = 0.0;
  };
  struct Job {
    State state = State::kNew;
    std::vector<Lease> leases;  // the first one is the oldest
    int attempt = 0, lost_workers = 0;
  };
  struct Worker {
    bus::Seconds beat = 0.0;
    int number = 0, capacity = 0;
    std::set<JobId> held;    // jobs that its last beat announced
    std::set<JobId> leases;  // jobs leased to it
    std::set<JobId> stuck;   // jobs that it holds beyond their lease
  };

  void leave_out_sleep(bus::Seconds now);
  bool is_silent(const Worker& worker, bus::Seconds now) const;
  bool has_successor(const Worker& worker) const;
  void bury_dead_workers(bus::Seconds now);
  void give_up_stuck_workers(bus::Seconds now);
  void end_leases(WorkerId id, Worker& worker);
  void end(JobId id, State state);
  void resend_unheard(bus::Seconds now, std::vector<Send>& sends);
  int room(const Worker& worker, bool suspect, bus::Seconds now) const;
  bool give(JobId id, bool to_idle, bus::Seconds now, std::vector<Send>& sends);
  void hand_out_new(bus::Seconds now, std::vector<Send>& sends);
  void hand_out_late(bus::Seconds now, std::vector<Send>& sends);
  bool is_late(const Job& job, bus::Seconds now) const;

  Limits limits_;
  std::map<JobId, Job> jobs_;
  std::deque<JobId> queue_;  // NEW jobs; may also contain jobs answered since
  std::map<WorkerId, Worker> workers_;
  RecentTimes times_;  // from giving a job to its result
  long open_ = 0, reissued_ = 0, resent_ = 0;
  bus::Seconds last_due_ = std::numeric_limits<bus::Seconds>::infinity();
};

}  // namespace rtg::jobs
