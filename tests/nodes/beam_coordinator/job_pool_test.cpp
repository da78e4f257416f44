#include "nodes/beam_coordinator/job_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <set>
#include <thread>

#include "tests/support/folder.hpp"

namespace rtg::beam_coordinator {
namespace {

using namespace std::chrono_literals;
using rtg_msgs::replay_job_t;

constexpr jobs::TaskShape kShape{.bodies = 1, .actions = 48};
constexpr int kUnit = jobs::ReplayService::kUnit.jobs;
constexpr std::int64_t kConfig = 77;
constexpr jobs::WorkerId kAnn = 1;

std::vector<search::ReplayJob> many_jobs(int count) {
  std::vector<search::ReplayJob> jobs;
  for (int k = 0; k < count; ++k) jobs.push_back({{{0.5 * k, 0.0, 0.0}}, k % 48});
  return jobs;
}

search::ReplayResult answer(const search::ReplayJob& job) {
  return {{{job.start[0].x + job.action, 1.0, 0.0}}, job.action % 2 == 0, 0.0};
}

/// A pool whose worker, Ann, is played by the test.
class Played {
 public:
  explicit Played(jobs::JobDispatcher::Limits limits = {}, jobs::UnitJournal* journal = nullptr)
      : pool(bus, kShape, kConfig, limits, journal) {
    bus.subscribe<replay_job_t>("RTG_REPLAY_JOB", [this](const replay_job_t& m) { on_job(m); });
  }

  void beat(std::int64_t config = kConfig, int capacity = 4) {
    rtg_msgs::worker_beat_t message{};
    message.incarnation = kAnn;
    message.config = config;
    message.capacity = capacity;
    bus.publish("RTG_REPLAY_BEAT", message);
  }

  /// Publishes the beat of a worker that holds the unit, if one is given, and can take four.
  void beat_of(jobs::WorkerId worker, std::optional<jobs::JobId> held) {
    rtg_msgs::worker_beat_t message{};
    message.incarnation = worker;
    message.config = kConfig;
    message.capacity = 4;
    if (held) message.held = {*held};
    message.n_held = static_cast<std::int32_t>(message.held.size());
    bus.publish("RTG_REPLAY_BEAT", message);
  }

  static rtg_msgs::replay_result_t result_of(const replay_job_t& job) {
    const std::vector<search::ReplayJob> jobs = jobs::ReplayService::parse(job, kShape).value();
    std::vector<search::ReplayResult> results;
    for (const search::ReplayJob& j : jobs) results.push_back(answer(j));
    auto message = jobs::ReplayService::message(results);
    message.job_id = job.job_id;
    return message;
  }

  void publish(const rtg_msgs::replay_result_t& message) {
    bus.publish("RTG_REPLAY_RESULT", message);
  }

  /// Returns what the pool answers, or nothing if it was stopped; serves the bus meanwhile.
  std::optional<std::vector<search::ReplayResult>> ask(const std::vector<search::ReplayJob>& jobs) {
    std::optional<std::vector<search::ReplayResult>> results;
    std::atomic<bool> ended = false;
    std::jthread search([&] {
      try {
        results = pool.answers(jobs);
      } catch (const Interrupted&) {
      }
      ended = true;
    });
    while (!ended) {
      bus.spin(1ms);
      pool.tick();
      if (each_round) each_round();
    }
    search.join();
    return results;
  }

  bus::Bus bus{"memq://", bus::RunKey::random("test")};
  JobPool<jobs::ReplayService> pool;
  std::function<void(const replay_job_t&)> on_job = [this](const replay_job_t& job) {
    publish(result_of(job));
  };
  std::function<void()> each_round;
};

void expect_right(const std::vector<search::ReplayJob>& jobs,
                  const std::optional<std::vector<search::ReplayResult>>& results) {
  ASSERT_TRUE(results.has_value());
  ASSERT_EQ(results->size(), jobs.size());
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    EXPECT_EQ((*results)[k].end, answer(jobs[k]).end);
    EXPECT_EQ((*results)[k].ok, answer(jobs[k]).ok);
  }
}

TEST(JobPool, AnswersInJobOrderHoweverTheUnitsComeBack) {
  Played played;
  std::vector<replay_job_t> waiting;
  played.on_job = [&](const replay_job_t& job) {
    EXPECT_EQ(job.to, kAnn);
    waiting.push_back(job);
  };
  played.each_round = [&] {  // last come, first served
    played.beat();
    if (waiting.empty()) return;
    played.publish(Played::result_of(waiting.back()));
    waiting.pop_back();
  };
  const auto jobs = many_jobs(14 * kUnit);
  expect_right(jobs, played.ask(jobs));
  expect_right({}, played.ask({}));
}

TEST(JobPool, EqualUnitsAreAskedOnce) {
  Played played;
  played.beat();
  int asked = 0;
  played.on_job = [&](const replay_job_t& job) {
    ++asked;
    played.publish(Played::result_of(job));
  };
  const std::vector<search::ReplayJob> jobs(2 * kUnit, many_jobs(2)[1]);
  expect_right(jobs, played.ask(jobs));
  EXPECT_EQ(asked, 1);
}

TEST(JobPool, CountsAndIgnoresResultsThatMakeNoSense) {
  Played played;
  played.beat();
  played.on_job = [&](const replay_job_t& job) {
    auto spoilt = Played::result_of(job);
    spoilt.ok[0] = 7;
    played.publish(spoilt);
    auto shorter =
        jobs::ReplayService::message(std::vector<search::ReplayResult>{answer(many_jobs(1)[0])});
    shorter.job_id = job.job_id;
    played.publish(shorter);
    auto unknown = Played::result_of(job);
    unknown.job_id = 123;
    played.publish(unknown);
    played.publish(Played::result_of(job));
    played.publish(Played::result_of(job));
  };
  const auto jobs = many_jobs(2 * kUnit);
  expect_right(jobs, played.ask(jobs));
  EXPECT_EQ(played.bus.counters().value("results.illegal"), 4);
  EXPECT_GE(played.bus.counters().value("results.unknown"), 2);
  EXPECT_GE(played.bus.counters().value("results.repeated"), 1);
}

TEST(JobPool, AWorkerOfAnotherConfigurationGetsNoWork) {
  Played played;
  played.beat(kConfig + 1);
  played.beat(kConfig, -1);
  played.beat(kConfig, 1 << 30);
  played.on_job = [](const replay_job_t&) { FAIL(); };
  played.each_round = [&] {
    if (played.bus.counters().value("beats.illegal") == 2) played.pool.stop();
  };
  EXPECT_FALSE(played.ask(many_jobs(3)).has_value());
  EXPECT_EQ(played.bus.counters().value("beats.other_configuration"), 1);
}

TEST(JobPool, SendsAgainWhatGotLost) {
  Played played({.resend = 0.0});
  std::set<jobs::JobId> lost;  // with all copies of their first message
  played.on_job = [&](const replay_job_t& job) {
    if (lost.size() < 5 && job.attempt == 1) lost.insert(job.job_id);
    if (job.attempt > 1 || !lost.contains(job.job_id)) played.publish(Played::result_of(job));
  };
  played.each_round = [&] { played.beat(); };
  const auto jobs = many_jobs(14 * kUnit);
  expect_right(jobs, played.ask(jobs));
  EXPECT_GE(played.pool.state().resent, 5);
}

TEST(JobPool, GivesUpAUnitThatNobodySurvives) {
  const testing::Folder folder;
  jobs::UnitJournal journal(folder.path / "journal", 5);
  Played played({.silence = 0.2, .poison = 2}, &journal);
  std::optional<jobs::JobId> deadly;
  jobs::WorkerId life = 1;
  bool alive = true;
  played.on_job = [&](const replay_job_t& job) {
    if (!deadly) deadly = job.job_id;
    if (job.job_id == *deadly) {
      played.beat_of(life, deadly);
      alive = false;
    }
    if (alive) played.publish(Played::result_of(job));
  };
  played.each_round = [&] {
    if (!alive && played.pool.state().workers == 0) {  // another one starts in its place
      ++life;
      alive = true;
    }
    if (alive) played.beat_of(life, std::nullopt);
  };
  const auto jobs = many_jobs(3 * kUnit);
  const auto results = played.ask(jobs);
  ASSERT_TRUE(results.has_value());
  EXPECT_EQ(played.pool.state().given_up, 1);
  EXPECT_GE(played.pool.state().reissued, 1);
  int skipped = 0;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    const search::ReplayResult& result = (*results)[k];
    if (result.end == answer(jobs[k]).end) continue;
    ++skipped;
    EXPECT_FALSE(result.ok);
    EXPECT_EQ(result.end, jobs[k].start);
  }
  EXPECT_EQ(skipped, kUnit);
  EXPECT_EQ(journal.size(), 3U) << "that it was given up is an answer, too";
}

TEST(JobPool, GivesUpAUnitThatHangsOnEveryLivingWorker) {
  Played played({.lease = 0.1, .poison = 2});
  std::optional<jobs::JobId> hanging;
  std::set<jobs::WorkerId> stuck;
  played.on_job = [&](const replay_job_t& job) {
    if (!hanging) hanging = job.job_id;
    if (job.job_id == *hanging)
      stuck.insert(job.to);
    else
      played.publish(Played::result_of(job));
  };
  played.each_round = [&] {  // there is always one more
    for (jobs::WorkerId worker = 1; worker <= std::ssize(stuck) + 1; ++worker)
      played.beat_of(worker, stuck.contains(worker) ? hanging : std::nullopt);
  };
  const auto jobs = many_jobs(3 * kUnit);
  const auto results = played.ask(jobs);
  ASSERT_TRUE(results.has_value());
  EXPECT_EQ(played.pool.state().given_up, 1);
  EXPECT_GE(stuck.size(), 2U);
  std::size_t answered = 0;
  for (std::size_t k = 0; k < jobs.size(); ++k)
    answered += (*results)[k].end == answer(jobs[k]).end;
  EXPECT_EQ(answered, 2U * kUnit);
}

TEST(JobPool, WhatTheJournalAnswersIsNotAskedAgain) {
  const testing::Folder folder;
  const auto jobs = many_jobs(3 * kUnit);
  {
    jobs::UnitJournal journal(folder.path / "journal", 5);
    Played killed({}, &journal);
    killed.beat();
    int answered = 0;
    killed.on_job = [&](const replay_job_t& job) {
      if (++answered <= 2) killed.publish(Played::result_of(job));
    };
    killed.each_round = [&] {
      if (journal.size() == 2) killed.pool.stop();
    };
    EXPECT_FALSE(killed.ask(jobs).has_value());
  }
  jobs::UnitJournal journal(folder.path / "journal", 5);
  Played again({}, &journal);
  again.beat();
  int asked = 0;
  again.on_job = [&](const replay_job_t& job) {
    ++asked;
    again.publish(Played::result_of(job));
  };
  expect_right(jobs, again.ask(jobs));
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(journal.units_found(), 2);
  expect_right(jobs, again.ask(jobs));
  EXPECT_EQ(asked, 1);
}

TEST(JobPool, AUnitThatWasGivenUpStaysSo) {
  const testing::Folder folder;
  const auto jobs = many_jobs(2 * kUnit);
  jobs::UnitJournal journal(folder.path / "journal", 5);
  journal.add_given_up(jobs::unit_id(std::span(jobs).first(kUnit), 5));
  Played played({}, &journal);
  played.beat();
  const auto results = played.ask(jobs);
  ASSERT_TRUE(results.has_value());
  EXPECT_EQ(played.pool.state().given_up, 1);
  EXPECT_EQ((*results)[0].end, jobs[0].start);
  EXPECT_EQ(results->back().end, answer(jobs.back()).end);
}

TEST(JobPool, StopEndsASearchThatWaits) {
  Played played;
  played.each_round = [&] { played.pool.stop(); };
  EXPECT_FALSE(played.ask(many_jobs(3)).has_value());
  EXPECT_FALSE(played.ask(many_jobs(3)).has_value());
}

}  // namespace
}  // namespace rtg::beam_coordinator
