#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "nodes/bus/run_key.hpp"
#include "nodes/jobs/job_dispatcher.hpp"
#include "nodes/jobs/job_inbox.hpp"
#include "nodes/jobs/unit_table.hpp"
#include "tests/support/faulty_network.hpp"
#include "tests/support/seeds.hpp"

// The two ends of the job protocol with the limits of the programs, in virtual time, over a network
// that loses, doubles, reorders and forges, with workers that are killed, paused or hang and are
// started again, and a coordinator that is paused.
namespace rtg::jobs {
namespace {

constexpr double kStep = 0.01, kBeatInterval = 0.02, kRestart = 0.5;
constexpr bus::Seconds kPatience = JobDispatcher::Limits{}.lease;

struct Faults {
  double kills = 0.0005, pauses = 0.0003;  // of a worker, per step
  double hangs = 0.0005;                   // share of the units that a worker never answers
  double forgeries = 0.02;                 // messages of strangers, per step
  bool authenticated = true;               // false: the tags of answers are not checked
  bool at_barrier = true;                  // false: answers are taken in the order of their arrival
};

/// A unit has one job, whose number is the unit's id.
struct Job {
  int number = 0;
};

JobId unit_id(std::span<const Job> jobs, std::int64_t /*config*/) { return jobs.front().number; }

struct Service {
  using Job = jobs::Job;
  using Result = int;
  static constexpr UnitLimit kUnit{.jobs = 1, .states = 1};
};

struct Answer {
  JobId job = 0;
  int result = 0;
};

constexpr const char* kAnswers = "RTG_ANSWERS";

std::vector<std::uint8_t> sealed(const Answer& answer, const bus::RunKey& key) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&answer);
  std::vector<std::uint8_t> bytes(begin, begin + sizeof(answer));
  key.seal(kAnswers, bytes);
  return bytes;
}

struct Worker {
  WorkerId id = 0;
  JobInbox<int, int> inbox{64};
  std::optional<JobId> busy;
  double begun = 0.0, done_at = 0.0, beat_at = 0.0;
  double starts_at = 0.0, paused_until = 0.0;
};

class Simulation {
 public:
  Simulation(std::uint64_t seed, const Faults& faults)
      : rng_(seed), network_({}, rng_), faults_(faults) {
    for (auto& worker : workers_) start(worker);
  }

  /// Returns the answers to `jobs`, as the search gets them: in the order of their jobs. Empty if
  /// it took too long.
  std::vector<int> solve(const std::vector<Job>& jobs) {
    arrived_.clear();
    dispatcher_.submit(units_.deal(jobs, {.bodies = 1, .actions = 1}, 0));
    for (const double end = now_ + 3000.0; !dispatcher_.finished();) {
      now_ += step();
      if (now_ > end) return {};
      network_.run(now_);
      for (std::size_t number = 0; number < workers_.size(); ++number) work(number);
      forge(jobs);
      if (now_ < paused_until_) continue;
      for (const auto& event : std::exchange(waiting_, {})) event();
      for (const auto& send : dispatcher_.due(now_)) deliver(send);
      if (rng_.uniform(0, 1) < faults_.pauses) paused_until_ = now_ + rng_.uniform(0.0, 10.0);
    }
    return faults_.at_barrier ? units_.take() : arrived_;
  }

  const JobDispatcher& dispatcher() const { return dispatcher_; }

 private:
  /// Returns the time to the next step: long ones while nothing but a hang goes on.
  double step() const {
    const auto idle = [](const auto& worker) { return !worker->busy || worker->done_at > 1e8; };
    return std::ranges::all_of(workers_, idle) && dispatcher_.open() > 0 && hanging() ? 0.5 : kStep;
  }
  bool hanging() const {
    return std::ranges::any_of(workers_, [](const auto& w) { return w->busy && w->done_at > 1e8; });
  }

  void start(std::unique_ptr<Worker>& worker) {
    worker = std::make_unique<Worker>();
    worker->id = ++lives_;
    worker->starts_at = now_ + kRestart;
  }

  void work(std::size_t number) {
    std::unique_ptr<Worker>& worker = workers_[number];
    if (now_ < worker->starts_at || now_ < worker->paused_until) return;
    const bool stuck = worker->busy && now_ - worker->begun > kPatience;
    if (stuck || rng_.uniform(0, 1) < faults_.kills) return start(worker);
    if (rng_.uniform(0, 1) < faults_.pauses) worker->paused_until = now_ + rng_.uniform(0.0, 45.0);
    if (worker->busy && now_ >= worker->done_at) {
      worker->inbox.finish(*worker->busy, answer_to(*worker->busy));
      report(*worker->busy, answer_to(*worker->busy));
      worker->busy.reset();
    }
    if (!worker->busy)
      if (const auto next = worker->inbox.take()) {
        worker->busy = next->first;
        worker->begun = now_;
        const bool hangs = rng_.uniform(0, 1) < faults_.hangs;
        worker->done_at = now_ + (hangs ? 1e9 : rng_.uniform(0.0, 0.3));
      }
    if (now_ < worker->beat_at) return;
    worker->beat_at = now_ + kBeatInterval;
    network_.send(now_, [this, id = worker->id, number, held = worker->inbox.held()] {
      hear([=, this] { dispatcher_.on_beat({id, static_cast<int>(number), 3, held}, now_); });
    });
  }

  void deliver(const JobDispatcher::Send& send) {
    network_.send(now_, [this, send] {
      for (auto& worker : workers_) {
        if (worker->id != send.worker || now_ < worker->starts_at) continue;
        if (const auto answer = worker->inbox.receive(send.job, 0)) report(send.job, *answer);
      }
    });
  }

  void report(JobId job, int result) { send(sealed({job, result}, key_)); }

  void forge(const std::vector<Job>& jobs) {
    if (rng_.uniform(0, 1) >= faults_.forgeries) return;
    const auto at = static_cast<std::size_t>(rng_.below(static_cast<int>(jobs.size())));
    send(sealed({jobs[at].number, -1}, strangers_));
  }

  void send(std::vector<std::uint8_t> bytes) {
    network_.send(now_, [this, bytes = std::move(bytes)] { hear([=, this] { receive(bytes); }); });
  }

  void receive(const std::vector<std::uint8_t>& bytes) {
    const auto message =
        faults_.authenticated ? key_.opened(kAnswers, bytes) : bus::without_tag(bytes);
    if (!message) return;
    Answer answer;
    std::memcpy(&answer, message->data(), sizeof(answer));
    accept(answer);
  }

  void accept(const Answer& answer) {
    if (!units_.contains(answer.job)) return;
    if (dispatcher_.on_result(answer.job, now_) != JobDispatcher::Verdict::kAccepted) return;
    units_.store(answer.job, std::array{answer.result});
    arrived_.push_back(answer.result);
  }

  /// Lets an event reach the coordinator, now or when it goes on.
  void hear(std::function<void()> event) {
    if (now_ < paused_until_)
      waiting_.push_back(std::move(event));
    else
      event();
  }

 public:
  static int answer_to(JobId job) { return static_cast<int>(job * 7 % 1000); }

 private:
  Rng rng_;
  testing::FaultyNetwork network_;
  Faults faults_;
  double now_ = 0.0, paused_until_ = 0.0;
  WorkerId lives_ = 0;
  std::array<std::unique_ptr<Worker>, 3> workers_;
  JobDispatcher dispatcher_;
  std::vector<std::function<void()>> waiting_;  // until the coordinator goes on
  UnitTable<Service> units_;
  std::vector<int> arrived_;  // answers, in the order in which they came
  bus::RunKey key_ = bus::RunKey::random("run"), strangers_ = bus::RunKey::random("run");
};

/// Counts of many simulations, each of two batches of twelve units.
struct Outcome {
  int wrong = 0;  // simulations with another answer, or none
  std::uint64_t first_wrong = 0;
  long reissued = 0, resent = 0, poisoned = 0;
};

Outcome outcome(const std::vector<std::uint64_t>& seeds, const Faults& faults) {
  Outcome found;
  for (const std::uint64_t seed : seeds) {
    Simulation simulation(seed, faults);
    bool right = true;
    for (const int batch : {0, 100}) {
      std::vector<Job> jobs;
      std::vector<int> expected;
      for (int number = batch; number < batch + 12; ++number) {
        jobs.push_back({number});
        expected.push_back(Simulation::answer_to(number));
      }
      right = right && simulation.solve(jobs) == expected;
      found.poisoned += static_cast<long>(simulation.dispatcher().poisoned().size());
    }
    if (!right && found.wrong++ == 0) found.first_wrong = seed;
    found.reissued += simulation.dispatcher().reissued();
    found.resent += simulation.dispatcher().resent();
  }
  return found;
}

TEST(JobProtocol, AnswersEveryJobOnceWhateverHappens) {
  const Outcome found = outcome(testing::seeds(10000), {});
  EXPECT_EQ(found.wrong, 0) << testing::replay(found.first_wrong);
  EXPECT_EQ(found.poisoned, 0);
  EXPECT_GT(found.reissued, 100) << "the faults did happen";
  EXPECT_GT(found.resent, 1000);
}

TEST(JobProtocol, GivesNothingUpAtFourTimesTheKills) {
  Faults faults;
  faults.kills *= 4.0;
  const Outcome found = outcome(testing::seeds(2000), faults);
  EXPECT_EQ(found.wrong, 0) << testing::replay(found.first_wrong);
  EXPECT_EQ(found.poisoned, 0);
}

// What the tag behind each message and the barrier before the search goes on are there for.
TEST(JobProtocol, WithoutAuthenticationForgeriesCount) {
  Faults faults;
  faults.authenticated = false;
  EXPECT_GT(outcome(testing::seeds(500), faults).wrong, 5);
}

TEST(JobProtocol, WithoutTheBarrierTheOrderOfArrivalCounts) {
  Faults faults;
  faults.at_barrier = false;
  EXPECT_GT(outcome(testing::seeds(500), faults).wrong, 40);
}

}  // namespace
}  // namespace rtg::jobs
