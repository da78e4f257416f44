#include "nodes/jobs/job_inbox.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rtg::jobs {
namespace {

using Inbox = JobInbox<int, std::string>;
using Ids = std::vector<JobId>;

TEST(JobInbox, AJobIsWorkedOnOnceHoweverOftenItArrives) {
  Inbox inbox(8);
  EXPECT_EQ(inbox.receive(7, 70), std::nullopt);
  EXPECT_EQ(inbox.receive(7, 70), std::nullopt);  // waits
  EXPECT_EQ(inbox.take(), (std::pair<JobId, int>{7, 70}));
  EXPECT_EQ(inbox.receive(7, 70), std::nullopt);  // is in work
  EXPECT_EQ(inbox.held(), Ids{7});
  EXPECT_EQ(inbox.take(), std::nullopt);
  inbox.finish(7, "seven");
  EXPECT_EQ(inbox.held(), Ids{});
  inbox.finish(7, "another");  // of a second worker thread: the first answer stays
  EXPECT_EQ(inbox.receive(7, 70), "seven");
  EXPECT_EQ(inbox.take(), std::nullopt);
}

TEST(JobInbox, JobsAreTakenInTheOrderOfTheirArrival) {
  Inbox inbox(8);
  for (const int k : {5, 3, 9}) inbox.receive(k, 10 * k);
  EXPECT_EQ(inbox.held(), (Ids{3, 5, 9}));
  for (const int k : {5, 3, 9}) EXPECT_EQ(inbox.take(), (std::pair<JobId, int>{k, 10 * k}));
}

TEST(JobInbox, TheOldestAnswersAreForgotten) {
  Inbox inbox(2);
  for (const int k : {1, 2, 3}) {
    inbox.receive(k, k);
    inbox.take();
    inbox.finish(k, std::to_string(k));
  }
  EXPECT_EQ(inbox.receive(2, 2), "2");
  EXPECT_EQ(inbox.receive(3, 3), "3");
  EXPECT_EQ(inbox.receive(1, 1), std::nullopt);
  EXPECT_EQ(inbox.take(), (std::pair<JobId, int>{1, 1}));
}

}  // namespace
}  // namespace rtg::jobs
