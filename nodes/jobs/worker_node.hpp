#pragma once

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <rtg_msgs/worker_beat_t.hpp>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "nodes/bus/bus.hpp"
#include "nodes/bus/node_status.hpp"
#include "nodes/jobs/copies.hpp"
#include "nodes/jobs/job_inbox.hpp"
#include "nodes/jobs/services.hpp"

namespace rtg::jobs {

/// A worker process for one kind of work, Service. The thread that spins the bus receives units and
/// sends beats. Other threads of the node compute the answers, so that beats continue during a long
/// solve.
template <class Service>
class WorkerNode {
 public:
  using Answer =
      std::function<std::vector<typename Service::Result>(std::span<const typename Service::Job>)>;
  struct Options {
    TaskShape shape;
    std::int64_t config = 0;  // hash of the configuration
    int number = 0;           // tells several workers apart, for people
    int threads = 1;
    bus::Seconds patience =
        JobDispatcher::Limits{}.lease;  // longest legal time of work on one unit
  };

  /// `answer` computes the results of a unit in job order. Several threads call it concurrently.
  WorkerNode(bus::Bus& bus, const Options& options, Answer answer)
      : bus_(bus),
        options_(options),
        answer_(std::move(answer)),
        watch_(bus),
        status_(bus, Service::kNode, options.number) {
    bus_.subscribe<JobMessage>(Service::kJobs, [this](const JobMessage& m) { receive(m); });
    for (int k = 0; k < options_.threads; ++k)
      threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  }

  /// Sends a beat and the status when they are due. Must be called after every Bus::spin().
  /// Rethrows an exception of `answer`.
  void tick(bus::Seconds now) {
    std::unique_lock lock(mutex_);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    const std::vector<JobId> held = inbox_.held();
    const long done = done_;
    lock.unlock();
    if (beat_.due(now)) send_beat(held);
    if (status_.due(now)) status_.publish(held.empty() ? "idle" : "busy", done);
  }

  /// Returns whether a unit has been in work for longer than `patience`. The process then has to
  /// end, because its thread cannot be stopped.
  bool stuck(bus::Seconds now) const {
    const std::scoped_lock lock(mutex_);
    return std::ranges::any_of(
        begun_, [&](const auto& unit) { return now - unit.second > options_.patience; });
  }

  /// Returns whether the node has ever received a unit of work.
  bool has_work() const {
    const std::scoped_lock lock(mutex_);
    return done_ > 0 || !inbox_.held().empty();
  }
  /// Returns the number of units answered so far.
  long units_done() const {
    const std::scoped_lock lock(mutex_);
    return done_;
  }
  const bus::CoordinatorWatch& coordinator() const { return watch_; }
  std::int64_t incarnation() const { return incarnation_; }

 private:
  using JobMessage = typename Service::JobMessage;
  using ResultMessage = typename Service::ResultMessage;
  using Jobs = std::vector<typename Service::Job>;
  static constexpr std::size_t kMostHeld = 3000;  // units; above every announced capacity

  void receive(const JobMessage& message) {
    if (message.to != incarnation_) return;
    std::optional<Jobs> jobs = Service::parse(message, options_.shape);
    if (!jobs) return bus_.counters().add("jobs.illegal");
    const bus::Seconds now = bus::monotonic_now();
    std::unique_lock lock(mutex_);
    if (inbox_.held().size() >= kMostHeld) return bus_.counters().add("jobs.too_many");
    const std::optional<ResultMessage> known = inbox_.receive(message.job_id, std::move(*jobs));
    if (known) copies_.on_repeat(now);
    const int copies = copies_.count(now);
    lock.unlock();
    if (!known) return wake_.notify_one();
    bus_.counters().add("jobs.answered_again");
    bus_.publish(Service::kResults, *known, copies);
  }

  void send_beat(const std::vector<JobId>& held) {
    rtg_msgs::worker_beat_t message{};
    message.incarnation = incarnation_;
    message.worker = options_.number;
    message.config = options_.config;
    message.capacity = 2 * options_.threads + 1;  // units in work and in transit
    message.held = held;
    message.n_held = static_cast<std::int32_t>(held.size());
    bus_.publish(Service::kBeats, message);
  }

  void work(const std::stop_token& stop) {
    try {
      while (const auto unit = next(stop)) {
        ResultMessage message = Service::message(answer_(unit->second));
        message.job_id = unit->first;
        message.incarnation = incarnation_;
        bus_.publish(Service::kResults, message, copies());
        const std::scoped_lock lock(mutex_);
        begun_.erase(unit->first);
        inbox_.finish(unit->first, std::move(message));
        ++done_;
      }
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  }

  int copies() const {
    const std::scoped_lock lock(mutex_);
    return copies_.count(bus::monotonic_now());
  }

  /// Waits for a unit and returns it. Returns nothing when the node stops.
  std::optional<std::pair<JobId, Jobs>> next(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    std::optional<std::pair<JobId, Jobs>> unit;
    wake_.wait(lock, stop, [&] { return (unit = inbox_.take()).has_value(); });
    if (unit) begun_[unit->first] = bus::monotonic_now();
    return stop.stop_requested() ? std::nullopt : std::move(unit);
  }

  bus::Bus& bus_;
  Options options_;
  Answer answer_;
  std::int64_t incarnation_ = bus::random_identity();
  bus::CoordinatorWatch watch_;
  bus::NodeStatus status_;
  bus::Ticker beat_{0.02};
  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable_any wake_;
  JobInbox<Jobs, ResultMessage> inbox_{64};
  std::map<JobId, bus::Seconds> begun_;  // units in work and their start times
  Copies copies_;
  long done_ = 0;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;  // last, so joined before the other members are destroyed
};

}  // namespace rtg::jobs
