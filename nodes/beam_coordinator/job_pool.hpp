#pragma once

#include <condition_variable>
#include <mutex>
#include <rtg_msgs/worker_beat_t.hpp>
#include <span>
#include <utility>
#include <vector>

#include "nodes/beam_coordinator/interrupted.hpp"
#include "nodes/bus/bus.hpp"
#include "nodes/bus/clock.hpp"
#include "nodes/jobs/copies.hpp"
#include "nodes/jobs/job_dispatcher.hpp"
#include "nodes/jobs/services.hpp"
#include "nodes/jobs/unit_journal.hpp"
#include "nodes/jobs/unit_table.hpp"

namespace rtg::beam_coordinator {

/// Counts of a JobPool, for progress and status messages.
struct PoolState {
  int workers = 0;  // alive
  long open = 0;    // units neither answered nor given up
  long resent = 0, reissued = 0, given_up = 0;
};

/// Has worker processes compute jobs of one kind, Service. answers() serves as SolveBatch or
/// ReplayBatch. The pool hides ids, units, retries and the order of answers. The search calls
/// answers() on its own thread; the thread that spins the bus calls tick(). With a journal, answers
/// are taken from it where it has them, and added to it as they come.
template <class Service>
class JobPool {
 public:
  using Job = typename Service::Job;
  using Result = typename Service::Result;

  JobPool(bus::Bus& bus, const jobs::TaskShape& shape, std::int64_t config,
          const jobs::JobDispatcher::Limits& limits = {}, jobs::UnitJournal* journal = nullptr)
      : bus_(bus), shape_(shape), config_(config), journal_(journal), dispatcher_(limits) {
    bus_.subscribe<Beat>(Service::kBeats, [this](const Beat& m) { on_beat(m); });
    bus_.subscribe<ResultMessage>(Service::kResults,
                                  [this](const ResultMessage& m) { on_result(m); });
  }

  /// Returns the results of `jobs` in job order, even if workers die and messages are lost. Blocks
  /// until every unit is answered or given up. Throws Interrupted once stop() has been called.
  std::vector<Result> answers(std::span<const Job> jobs) {
    std::unique_lock lock(mutex_);
    std::vector<jobs::JobId> open =
        units_.deal(jobs, shape_, journal_ ? journal_->generation() : config_);
    std::erase_if(open, [this](jobs::JobId id) { return is_known(id); });
    dispatcher_.submit(open);
    send_due();
    changed_.wait(lock, [this] { return stopped_ || dispatcher_.finished(); });
    for (const jobs::JobId id : dispatcher_.poisoned()) {
      if (journal_) journal_->add_given_up(id);
      give_up(id);
    }
    dispatcher_.submit({});
    std::vector<Result> results = units_.take();
    if (stopped_) throw Interrupted();
    return results;
  }

  /// Sends the units that are due, for example again after the loss of a worker or a message.
  void tick() {
    const std::scoped_lock lock(mutex_);
    send_due();
    if (dispatcher_.finished()) changed_.notify_all();  // a poisoned unit has no result
  }

  void stop() {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

  PoolState state() const {
    const std::scoped_lock lock(mutex_);
    return {dispatcher_.workers(), dispatcher_.open(), dispatcher_.resent(), dispatcher_.reissued(),
            given_up_};
  }

 private:
  using Beat = rtg_msgs::worker_beat_t;
  using ResultMessage = typename Service::ResultMessage;
  static constexpr int kMostCapacity = 10000;

  void on_beat(const Beat& message) {
    if (message.capacity < 0 || message.capacity > kMostCapacity)
      return bus_.counters().add("beats.illegal");
    if (message.config != config_) return bus_.counters().add("beats.other_configuration");
    const std::scoped_lock lock(mutex_);
    dispatcher_.on_beat({message.incarnation, message.worker, message.capacity, message.held},
                        bus::monotonic_now());
    send_due();
  }

  void on_result(const ResultMessage& message) {
    const std::scoped_lock lock(mutex_);
    const jobs::JobId id = message.job_id;
    if (!units_.contains(id)) return bus_.counters().add("results.unknown");
    const auto results = Service::parse(message, shape_);
    if (!results || results->size() != units_.jobs(id).size())
      return bus_.counters().add("results.illegal");
    if (dispatcher_.on_result(id, bus::monotonic_now()) != jobs::JobDispatcher::Verdict::kAccepted)
      return bus_.counters().add("results.repeated");
    if (journal_) journal_->add(id, message);
    units_.store(id, *results);
    send_due();
    if (dispatcher_.finished()) changed_.notify_all();
  }

  void send_due() {
    const bus::Seconds now = bus::monotonic_now();
    const long resent = dispatcher_.resent();
    const auto sends = dispatcher_.due(now);
    if (dispatcher_.resent() > resent) copies_.on_repeat(now);
    for (const auto& [worker, id, attempt] : sends) {
      auto message = Service::message(units_.jobs(id));
      message.job_id = id;
      message.to = worker;
      message.attempt = attempt;
      bus_.publish(Service::kJobs, std::move(message), copies_.count(now));
    }
  }

  /// Returns whether the journal has an answer to unit `id`, which then is that of the pool.
  bool is_known(jobs::JobId id) {
    if (!journal_) return false;
    const auto results = journal_->find<Service>(id, units_.jobs(id).size(), shape_);
    if (results && results->empty())
      give_up(id);
    else if (results)
      units_.store(id, *results);
    return results.has_value();
  }

  void give_up(jobs::JobId id) {
    ++given_up_;
    std::vector<Result> results;
    for (const Job& job : units_.jobs(id)) results.push_back(Service::given_up(job));
    units_.store(id, results);
  }

  bus::Bus& bus_;
  jobs::TaskShape shape_;
  std::int64_t config_;
  jobs::UnitJournal* journal_;
  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  jobs::JobDispatcher dispatcher_;
  jobs::UnitTable<Service> units_;
  jobs::Copies copies_;
  bool stopped_ = false;
  long given_up_ = 0;
};

}  // namespace rtg::beam_coordinator
