#include <gtest/gtest.h>

#include <memory>

#include "nodes/jobs/job_dispatcher.hpp"
#include "nodes/jobs/job_inbox.hpp"
#include "tests/nodes/jobs/faulty_network.hpp"

// The two ends of the job protocol in virtual time, over a network that loses, doubles and
// reorders, with workers that are killed or hang and are started again. A failing seed is printed
// and can be run alone.
namespace rtg::jobs {
namespace {

constexpr double kStep = 0.01, kBeatInterval = 0.2, kPatience = 3.0;
constexpr double kHangs = 0.01;  // share of the units that a worker never answers, however alive

struct Worker {
  WorkerId id = 0;
  JobInbox<int, int> inbox{8};
  std::optional<JobId> busy;
  double begun = 0.0, done_at = 0.0, beat_at = 0.0;
};

class Simulation {
 public:
  Simulation(std::uint64_t seed, double kill_rate)
      : rng_(seed), network_({}, rng_), kill_rate_(kill_rate) {
    for (auto& worker : workers_) start(worker);
  }

  /// Answers by job, as the coordinator accepted them; empty if it took too long.
  std::map<JobId, int> solve(const std::vector<JobId>& jobs) {
    accepted_.clear();
    dispatcher_.submit(jobs);
    for (const double end = now_ + 300.0; !dispatcher_.finished();) {
      now_ += kStep;
      if (now_ > end) return {};
      network_.run(now_);
      for (auto& worker : workers_) work(worker);
      for (const auto& send : dispatcher_.due(now_)) deliver(send);
    }
    return accepted_;
  }

  const JobDispatcher& dispatcher() const { return dispatcher_; }

 private:
  void start(std::unique_ptr<Worker>& worker) {
    worker = std::make_unique<Worker>();
    worker->id = ++lives_;
  }

  void work(std::unique_ptr<Worker>& worker) {
    const bool stuck = worker->busy && now_ - worker->begun > kPatience;
    if (stuck || rng_.uniform(0, 1) < kill_rate_) start(worker);
    if (worker->busy && now_ >= worker->done_at) {
      worker->inbox.finish(*worker->busy, answer_to(*worker->busy));
      report(*worker->busy, answer_to(*worker->busy));
      worker->busy.reset();
    }
    if (!worker->busy)
      if (const auto next = worker->inbox.take()) {
        worker->busy = next->first;
        worker->begun = now_;
        worker->done_at = now_ + (rng_.uniform(0, 1) < kHangs ? 1e9 : rng_.uniform(0.0, 0.3));
      }
    if (now_ < worker->beat_at) return;
    worker->beat_at = now_ + kBeatInterval;
    network_.send(now_, [this, id = worker->id, held = worker->inbox.held()] {
      dispatcher_.on_beat({id, 2, held}, now_);
    });
  }

  void deliver(const JobDispatcher::Send& send) {
    network_.send(now_, [this, send] {
      for (auto& worker : workers_) {
        if (worker->id != send.worker) continue;
        if (const auto answer = worker->inbox.receive(send.job, 0)) report(send.job, *answer);
      }
    });
  }

  void report(JobId job, int answer) {
    network_.send(now_, [this, job, answer] {
      if (dispatcher_.on_result(job) == JobDispatcher::Verdict::kAccepted) {
        EXPECT_TRUE(accepted_.emplace(job, answer).second);
      }
    });
  }

  static int answer_to(JobId job) { return static_cast<int>(job * 7 % 1000); }

  Rng rng_;
  testing::FaultyNetwork network_;
  double kill_rate_;
  double now_ = 0.0;
  WorkerId lives_ = 0;
  std::array<std::unique_ptr<Worker>, 3> workers_;
  JobDispatcher dispatcher_{{.lease = kPatience, .poison = 1000}};
  std::map<JobId, int> accepted_;
};

TEST(JobProtocol, AnswersEveryJobOnceUnderLossDuplicationReorderKillsAndHangs) {
  long reissued = 0, resent = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Simulation simulation(seed, 0.0005);
    for (const JobId batch : {0, 100}) {
      std::vector<JobId> jobs;
      std::map<JobId, int> expected;
      for (JobId id = batch; id < batch + 12; ++id) {
        jobs.push_back(id);
        expected[id] = static_cast<int>(id * 7 % 1000);
      }
      ASSERT_EQ(simulation.solve(jobs), expected) << "seed " << seed;
    }
    reissued += simulation.dispatcher().reissued();
    resent += simulation.dispatcher().resent();
  }
  EXPECT_GT(reissued, 100);  // the faults did happen
  EXPECT_GT(resent, 1000);
}

}  // namespace
}  // namespace rtg::jobs
