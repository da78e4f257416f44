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

/// Content-determined name of a unit of work: equal questions have equal ids.
using JobId = std::int64_t;
/// A life of a worker process.
using WorkerId = std::int64_t;

/// Who works on what, over a network that loses, doubles and reorders, with workers that die: NEW
/// -> LEASED -> DONE or POISON. Free of I/O: events in, messages to send out, the clock passed in.
///
/// Workers announce capacity and what they hold; a lease they do not hold is sent again. A worker
/// is lost when it falls silent, and also when it sits on a job for longer than any job takes,
/// however alive: it gets nothing more until it lets go of that job. The leases of a lost worker go
/// to others, each alone so that one deadly job does not make its neighbours look deadly; a job
/// that cost several workers is poison. Results count by id, whoever sends them and whatever the
/// attempt.
class JobDispatcher {
 public:
  struct Limits {
    bus::Seconds silence = 2.0;  // without a beat for so long: dead
    bus::Seconds resend = 0.1;   // a beat so long after sending should list the job
    bus::Seconds lease = 300.0;  // from lease to result, some hundred times what a job takes: stuck
    int poison = 3;              // lost workers that held one job until it is given up
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

  /// A new set of jobs, handed out in this order; equal ids are one job. Forgets the set before.
  void submit(std::span<const JobId> jobs);

  void on_beat(const Beat& beat, bus::Seconds now);
  Verdict on_result(JobId job);

  /// The messages that have to be sent now. To be called after every event and a few times a
  /// second: where `silence` / 2 passed without a call, this process slept and heard nobody, so
  /// that the clocks of the workers stood still meanwhile.
  std::vector<Send> due(bus::Seconds now);

  bool finished() const { return open_ == 0; }
  long open() const { return open_; }
  int workers() const { return static_cast<int>(workers_.size()); }
  std::vector<JobId> poisoned() const;
  long reissued() const { return reissued_; }  // leases taken back from lost workers
  long resent() const { return resent_; }      // messages said again

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
    std::set<JobId> leases;  // as we see it
    std::set<JobId> stuck;   // of what it holds: leases that have run out
  };

  void leave_out_sleep(bus::Seconds now);
  void bury_silent_workers(bus::Seconds now);
  void give_up_stuck_workers(bus::Seconds now);
  void take_back(JobId id, bool victim);
  void resend_unheard(bus::Seconds now, std::vector<Send>& sends);
  int room(const Worker& worker, bool suspect) const;
  void hand_out(bus::Seconds now, std::vector<Send>& sends);

  Limits limits_;
  std::map<JobId, Job> jobs_;
  std::deque<JobId> queue_;  // NEW, plus ids that have been answered meanwhile
  std::map<WorkerId, Worker> workers_;
  long open_ = 0, reissued_ = 0, resent_ = 0;
  bus::Seconds last_due_ = std::numeric_limits<bus::Seconds>::infinity();
};

}  // namespace rtg::jobs
