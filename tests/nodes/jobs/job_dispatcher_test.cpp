#include "nodes/jobs/job_dispatcher.hpp"

#include <gtest/gtest.h>

#include <set>

namespace rtg::jobs {
namespace {

using Send = JobDispatcher::Send;
using Verdict = JobDispatcher::Verdict;
using Ids = std::vector<JobId>;
using Sends = std::vector<Send>;

constexpr WorkerId kAnn = 1, kBob = 2, kCat = 3;

void beat(JobDispatcher& jobs, WorkerId worker, bus::Seconds now, const Ids& held = {},
          int capacity = 2) {
  jobs.on_beat({worker, static_cast<int>(worker), capacity, held}, now);
}

/// A worker that is started again each time it dies: its lives have one number.
void beat_of_life(JobDispatcher& jobs, WorkerId life, bus::Seconds now, const Ids& held = {}) {
  jobs.on_beat({life, 7, 2, held}, now);
}

/// Returns what is sent from `begin` to `end` when nothing is heard.
Sends sent_between(JobDispatcher& jobs, bus::Seconds begin, bus::Seconds end) {
  Sends sends;
  for (bus::Seconds now = begin; now <= end; now += 0.5)
    for (const Send& send : jobs.due(now)) sends.push_back(send);
  return sends;
}

TEST(JobDispatcher, FillsTheFreestWorkerFirst) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 11, 12, 13});
  EXPECT_EQ(jobs.due(0.0), Sends{});
  beat(jobs, kAnn, 0.0);
  beat(jobs, kBob, 0.0, {}, 1);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 10, 1}, {kAnn, 11, 1}, {kBob, 12, 1}}));
  EXPECT_EQ(jobs.on_result(11, 0.0), Verdict::kAccepted);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 13, 1}}));
  for (const JobId id : {10, 12, 13}) jobs.on_result(id, 0.0);
  EXPECT_TRUE(jobs.finished());
}

TEST(JobDispatcher, ResultsCountOnceAndWhoeverSendsThem) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 10, 11});
  EXPECT_EQ(jobs.open(), 2);
  EXPECT_EQ(jobs.on_result(10, 0.0), Verdict::kAccepted);  // nobody was asked yet
  EXPECT_EQ(jobs.on_result(10, 0.0), Verdict::kDuplicate);
  EXPECT_EQ(jobs.on_result(99, 0.0), Verdict::kUnknown);
  beat(jobs, kAnn, 0.0);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 11, 1}}));
}

TEST(JobDispatcher, SendsAgainWhatALaterBeatDoesNotList) {
  JobDispatcher jobs;
  jobs.submit(Ids{10});
  beat(jobs, kAnn, 0.0);
  jobs.due(0.0);
  beat(jobs, kAnn, 0.01);  // may have left before the job arrived
  EXPECT_EQ(jobs.due(0.01), Sends{});
  beat(jobs, kAnn, 0.3);
  EXPECT_EQ(jobs.due(0.3), (Sends{{kAnn, 10, 2}}));
  beat(jobs, kAnn, 0.9, {10});
  EXPECT_EQ(jobs.due(0.9), Sends{});
  EXPECT_EQ(jobs.resent(), 1);
}

TEST(JobDispatcher, GivesTheJobsOfASilentWorkerToAnother) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 11});
  beat(jobs, kAnn, 0.0, {}, 1);
  sent_between(jobs, 0.0, 1.5);
  beat(jobs, kBob, 1.9, {}, 4);
  EXPECT_EQ(jobs.due(1.9), (Sends{{kBob, 11, 1}}));
  EXPECT_EQ(jobs.due(2.1), (Sends{{kBob, 10, 2}}));
  EXPECT_EQ(jobs.workers(), 1);
  EXPECT_EQ(jobs.reissued(), 1);
  EXPECT_EQ(jobs.on_result(10, 0.0), Verdict::kAccepted);
}

// A frozen worker thaws.
TEST(JobDispatcher, AWorkerThatComesBackHasKeptItsJobs) {
  JobDispatcher jobs({.poison = 1});
  jobs.submit(Ids{10, 11, 12});
  beat(jobs, kAnn, 0.0);
  sent_between(jobs, 0.0, 40.0);
  EXPECT_EQ(jobs.workers(), 0);
  beat(jobs, kAnn, 40.5, {10, 11});
  EXPECT_EQ(jobs.due(40.5), Sends{});  // it has them already
  EXPECT_EQ(jobs.on_result(10, 40.6), Verdict::kAccepted);
  EXPECT_EQ(jobs.due(40.6), (Sends{{kAnn, 12, 1}}));
  EXPECT_EQ(jobs.reissued(), 0);
  EXPECT_EQ(jobs.poisoned(), Ids{});
}

// It has answered `count` jobs in 0.1 s each.
JobDispatcher practised(int count) {
  JobDispatcher jobs;
  for (int k = 0; k < count; ++k) {
    jobs.submit(Ids{1000 + k});
    beat(jobs, kAnn, 0.2 * k);
    jobs.due(0.2 * k);
    jobs.on_result(1000 + k, 0.2 * k + 0.1);
  }
  jobs.submit(Ids{10});
  return jobs;
}

TEST(JobDispatcher, AJobThatTakesLongGoesToAnIdleWorkerToo) {
  JobDispatcher jobs = practised(20);
  beat(jobs, kAnn, 10.0);
  EXPECT_EQ(jobs.due(10.0), (Sends{{kAnn, 10, 1}}));
  beat(jobs, kBob, 10.1);
  EXPECT_EQ(jobs.due(10.2), Sends{});
  beat(jobs, kAnn, 10.3, {10});
  EXPECT_EQ(jobs.due(10.4), (Sends{{kBob, 10, 2}}));  // three times 0.1 s
  beat(jobs, kCat, 10.4);
  EXPECT_EQ(jobs.due(10.9), Sends{}) << "twice is enough";
  EXPECT_EQ(jobs.on_result(10, 11.0), Verdict::kAccepted);
  EXPECT_EQ(jobs.on_result(10, 11.1), Verdict::kDuplicate);
  EXPECT_TRUE(jobs.finished());
}

TEST(JobDispatcher, WhatIsLongIsNotKnownFromAFewJobs) {
  JobDispatcher jobs = practised(5);
  beat(jobs, kAnn, 10.0);
  jobs.due(10.0);
  beat(jobs, kAnn, 11.0, {10});
  beat(jobs, kBob, 11.0);
  EXPECT_EQ(jobs.due(11.0), Sends{});
}

/// Lets a worker that holds the jobs beat once a second until `end`; returns what is sent
/// meanwhile.
Sends beats_until(JobDispatcher& jobs, WorkerId worker, const Ids& held, bus::Seconds begin,
                  bus::Seconds end) {
  Sends sends;
  for (bus::Seconds now = begin; now <= end; now += 1.0) {
    beat(jobs, worker, now, held);
    for (const Send& send : jobs.due(now)) sends.push_back(send);
  }
  return sends;
}

TEST(JobDispatcher, AStuckWorkerLosesItsJobsHoweverAlive) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 11});
  beat(jobs, kAnn, 0.0);
  jobs.due(0.0);
  EXPECT_EQ(beats_until(jobs, kAnn, {10, 11}, 1.0, 301.0), Sends{});
  beat(jobs, kBob, 301.0, {}, 3);
  EXPECT_EQ(jobs.due(301.0), (Sends{{kBob, 11, 2}}));  // alone: it may have been the one
  EXPECT_EQ(jobs.on_result(11, 0.0), Verdict::kAccepted);
  EXPECT_EQ(jobs.due(301.0), (Sends{{kBob, 10, 2}}));
  EXPECT_EQ(jobs.reissued(), 2);
}

TEST(JobDispatcher, AStuckWorkerGetsNothingUntilItLetsGo) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 11, 12});
  beat(jobs, kAnn, 0.0);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 10, 1}, {kAnn, 11, 1}}));
  EXPECT_EQ(beats_until(jobs, kAnn, {10, 11}, 1.0, 1000.0), Sends{});
  EXPECT_EQ(jobs.on_result(10, 0.0), Verdict::kAccepted);  // slow, not stuck
  beat(jobs, kAnn, 1001.0, {11});
  EXPECT_EQ(jobs.due(1001.0), Sends{});
  EXPECT_EQ(jobs.on_result(11, 0.0), Verdict::kAccepted);
  beat(jobs, kAnn, 1002.0);
  EXPECT_EQ(jobs.due(1002.0), (Sends{{kAnn, 12, 1}}));
  EXPECT_EQ(jobs.poisoned(), Ids{});
}

TEST(JobDispatcher, AJobThatLivingWorkersGetStuckWithIsPoison) {
  JobDispatcher jobs({.poison = 3});
  jobs.submit(Ids{10, 11});
  std::set<WorkerId> stuck;  // each holds 10 for ever
  int sent = 0;
  for (bus::Seconds now = 0.0; now < 2000.0 && !jobs.finished(); now += 1.0) {
    for (const WorkerId worker : {kAnn, kBob, kCat})
      beat(jobs, worker, now, stuck.contains(worker) ? Ids{10} : Ids{});
    for (const Send& send : jobs.due(now)) {
      ++sent;
      if (send.job == 10)
        stuck.insert(send.worker);
      else
        jobs.on_result(send.job, 0.0);
    }
  }
  EXPECT_TRUE(jobs.finished());
  EXPECT_EQ(sent, 4);
  EXPECT_EQ(stuck.size(), 3U);
  EXPECT_EQ(jobs.poisoned(), Ids{10});
  EXPECT_EQ(jobs.reissued(), 2);
}

TEST(JobDispatcher, AJobThatNeverReachedItsWorkerCountsNoLostWorker) {
  JobDispatcher jobs({.poison = 1});
  jobs.submit(Ids{10});
  beat(jobs, kAnn, 0.0);
  jobs.due(0.0);
  const Sends sends = beats_until(jobs, kAnn, {}, 1.0, 1000.0);
  EXPECT_EQ(jobs.poisoned(), Ids{});
  EXPECT_EQ(jobs.reissued(), 3);  // after 301, 602 and 903 s
  EXPECT_EQ(sends.size(), 1000U);
}

TEST(JobDispatcher, AJobThatTakesFiveWorkersDownIsPoison) {
  JobDispatcher jobs;
  jobs.submit(Ids{10});
  bus::Seconds now = 0.0;
  for (WorkerId life = 1; life <= 6; ++life) {
    beat_of_life(jobs, life, now);
    EXPECT_EQ(sent_between(jobs, now, now + 2.5).size(), life <= 5 ? 1u : 0u);
    beat_of_life(jobs, life, now + 0.5, {10});
    now += 3.0;
  }
  EXPECT_TRUE(jobs.finished());
  EXPECT_EQ(jobs.poisoned(), Ids{10});
  EXPECT_EQ(jobs.on_result(10, 0.0), Verdict::kDuplicate);
}

// Units are innocent of what others do to workers that had not yet received them.
TEST(JobDispatcher, AJobThatADeadWorkerNeverHeldIsNoSuspect) {
  JobDispatcher jobs({.poison = 1});
  jobs.submit(Ids{10});
  for (WorkerId life = 1; life <= 9; ++life) {
    beat_of_life(jobs, life, 3.0 * static_cast<double>(life));
    jobs.due(3.0 * static_cast<double>(life));
  }
  EXPECT_EQ(jobs.poisoned(), Ids{});
}

TEST(JobDispatcher, AJobThatSawAWorkerDieIsTriedAloneSoThatOthersDoNotShareItsFate) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 11, 12});
  beat_of_life(jobs, 1, 0.0);
  EXPECT_EQ(jobs.due(0.0), (Sends{{1, 10, 1}, {1, 11, 1}}));
  beat_of_life(jobs, 1, 0.5, {10, 11});
  jobs.due(0.5);
  for (bus::Seconds now = 1.0; now < 3.0; now += 0.5) jobs.due(now);
  beat_of_life(jobs, 2, 3.0);
  EXPECT_EQ(jobs.due(3.0), (Sends{{2, 11, 2}}));
  jobs.on_result(11, 3.0);
  EXPECT_EQ(jobs.due(3.0), (Sends{{2, 10, 2}}));
  beat(jobs, kCat, 4.0, {}, 2);
  EXPECT_EQ(jobs.due(4.0), (Sends{{kCat, 12, 1}}));
}

TEST(JobDispatcher, ASilentWorkerWithoutASuccessorIsLostAfterTheLease) {
  JobDispatcher jobs({.poison = 1});
  jobs.submit(Ids{10});
  beat(jobs, kAnn, 0.0);
  jobs.due(0.0);
  beat(jobs, kAnn, 0.5, {10});
  sent_between(jobs, 0.5, 299.0);
  EXPECT_EQ(jobs.poisoned(), Ids{});
  sent_between(jobs, 299.5, 302.0);
  EXPECT_EQ(jobs.poisoned(), Ids{10});
}

// A machine that was suspended: the beats of the living wait in the queue, the first one read would
// bury everybody else.
TEST(JobDispatcher, ASleepOfItsOwnBuriesNobody) {
  JobDispatcher jobs({.poison = 1});
  jobs.submit(Ids{10, 11});
  for (const WorkerId worker : {kAnn, kBob}) beat(jobs, worker, 0.0, {}, 1);
  EXPECT_EQ(jobs.due(0.0).size(), 2U);
  for (bus::Seconds now = 10.0; now < 2000.0; now += 500.0) {  // longer than a lease, too
    beat(jobs, kAnn, now, {10}, 1);
    EXPECT_EQ(jobs.due(now), Sends{});
    beat(jobs, kBob, now, {11}, 1);
    EXPECT_EQ(jobs.due(now), Sends{});
  }
  EXPECT_EQ(jobs.reissued(), 0);
  EXPECT_EQ(jobs.workers(), 2);
  sent_between(jobs, 1510.0, 1513.0);
  EXPECT_EQ(jobs.workers(), 0) << "awake, it hears that they are silent";
}

TEST(JobDispatcher, ANewSetForgetsTheOldOne) {
  JobDispatcher jobs;
  jobs.submit(Ids{10});
  beat(jobs, kAnn, 0.0, {}, 1);
  jobs.due(0.0);
  jobs.submit(Ids{20});
  EXPECT_EQ(jobs.on_result(10, 0.0), Verdict::kUnknown);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 20, 1}}));
}

}  // namespace
}  // namespace rtg::jobs
