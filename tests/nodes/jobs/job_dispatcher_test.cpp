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
  jobs.on_beat({worker, capacity, held}, now);
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
  EXPECT_EQ(jobs.on_result(11), Verdict::kAccepted);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 13, 1}}));
  for (const JobId id : {10, 12, 13}) jobs.on_result(id);
  EXPECT_TRUE(jobs.finished());
}

TEST(JobDispatcher, ResultsCountOnceAndWhoeverSendsThem) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 10, 11});
  EXPECT_EQ(jobs.open(), 2);
  EXPECT_EQ(jobs.on_result(10), Verdict::kAccepted);  // nobody was asked yet
  EXPECT_EQ(jobs.on_result(10), Verdict::kDuplicate);
  EXPECT_EQ(jobs.on_result(99), Verdict::kUnknown);
  beat(jobs, kAnn, 0.0);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 11, 1}}));
}

TEST(JobDispatcher, SendsAgainWhatALaterBeatDoesNotList) {
  JobDispatcher jobs;
  jobs.submit(Ids{10});
  beat(jobs, kAnn, 0.0);
  jobs.due(0.0);
  beat(jobs, kAnn, 0.05);  // may have left before the job arrived
  EXPECT_EQ(jobs.due(0.05), Sends{});
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
  EXPECT_EQ(jobs.due(2.1), Sends{});
  EXPECT_EQ(jobs.on_result(11), Verdict::kAccepted);
  EXPECT_EQ(jobs.due(2.1), (Sends{{kBob, 10, 2}}));
  EXPECT_EQ(jobs.workers(), 1);
  EXPECT_EQ(jobs.reissued(), 1);
  EXPECT_EQ(jobs.on_result(10), Verdict::kAccepted);
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
  EXPECT_EQ(jobs.on_result(11), Verdict::kAccepted);
  EXPECT_EQ(jobs.due(301.0), (Sends{{kBob, 10, 2}}));
  EXPECT_EQ(jobs.reissued(), 2);
}

TEST(JobDispatcher, AStuckWorkerGetsNothingUntilItLetsGo) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 11, 12});
  beat(jobs, kAnn, 0.0);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 10, 1}, {kAnn, 11, 1}}));
  EXPECT_EQ(beats_until(jobs, kAnn, {10, 11}, 1.0, 1000.0), Sends{});
  EXPECT_EQ(jobs.on_result(10), Verdict::kAccepted);  // slow, not stuck
  beat(jobs, kAnn, 1001.0, {11});
  EXPECT_EQ(jobs.due(1001.0), Sends{});
  EXPECT_EQ(jobs.on_result(11), Verdict::kAccepted);
  beat(jobs, kAnn, 1002.0);
  EXPECT_EQ(jobs.due(1002.0), (Sends{{kAnn, 12, 1}}));
  EXPECT_EQ(jobs.poisoned(), Ids{});
}

TEST(JobDispatcher, AJobThatThreeLivingWorkersGetStuckWithIsPoison) {
  JobDispatcher jobs;
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
        jobs.on_result(send.job);
    }
  }
  EXPECT_TRUE(jobs.finished());
  EXPECT_EQ(sent, 4);
  EXPECT_EQ(stuck.size(), 3U);
  EXPECT_EQ(jobs.poisoned(), Ids{10});
  EXPECT_EQ(jobs.reissued(), 3);
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

TEST(JobDispatcher, AJobThatTakesThreeWorkersDownIsPoison) {
  JobDispatcher jobs;
  jobs.submit(Ids{10});
  bus::Seconds now = 0.0;
  for (const WorkerId lost : {kAnn, kBob, kCat}) {
    beat(jobs, lost, now);
    EXPECT_EQ(sent_between(jobs, now, now + 2.5).size(), 1u);
    now += 3.0;
  }
  EXPECT_EQ(jobs.due(now), Sends{});
  EXPECT_TRUE(jobs.finished());
  EXPECT_EQ(jobs.poisoned(), Ids{10});
  EXPECT_EQ(jobs.on_result(10), Verdict::kDuplicate);
}

TEST(JobDispatcher, AJobThatSawAWorkerDieIsTriedAloneSoThatOthersDoNotShareItsFate) {
  JobDispatcher jobs;
  jobs.submit(Ids{10, 11, 12});
  beat(jobs, kAnn, 0.0);
  EXPECT_EQ(sent_between(jobs, 0.0, 2.5), (Sends{{kAnn, 10, 1}, {kAnn, 11, 1}}));
  beat(jobs, kBob, 3.0, {}, 2);
  EXPECT_EQ(jobs.due(3.0), (Sends{{kBob, 11, 2}}));
  jobs.on_result(11);
  EXPECT_EQ(jobs.due(3.0), (Sends{{kBob, 10, 2}}));
  beat(jobs, kCat, 4.0, {}, 2);
  EXPECT_EQ(jobs.due(4.0), (Sends{{kCat, 12, 1}}));
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
  EXPECT_EQ(jobs.on_result(10), Verdict::kUnknown);
  EXPECT_EQ(jobs.due(0.0), (Sends{{kAnn, 20, 1}}));
}

}  // namespace
}  // namespace rtg::jobs
