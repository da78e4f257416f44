#include "core/search/coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/art_manip.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::search {
namespace {

using testing::gathering;

/// A transition from the nominal start that moves the robot, and the first `objects` objects by
/// `distance`.
Transition moving(int objects, double distance) {
  Transition t{gathering().start, 0, gathering().start, false, Source::kTree};
  t.next[0].x += 2.0;
  for (int k = 1; k <= objects; ++k) t.next[static_cast<std::size_t>(k)].y -= distance;
  return t;
}

TEST(Coverage, SharesAreZeroWithoutTransitions) {
  const tasks::Task task = gathering();
  const Coverage coverage(task);
  EXPECT_EQ(coverage.transitions(), 0);
  EXPECT_EQ(coverage.figures().contact_share, 0.0);
  EXPECT_EQ(coverage.figures().multi_body_share, 0.0);
}

TEST(Coverage, CountsTransitionsThatMoveOneObjectOrMore) {
  const tasks::Task task = gathering();
  Coverage coverage(task);
  for (const int objects : {0, 0, 0, 1, 1, 2, 3, 0}) coverage.add(moving(objects, 0.06));
  coverage.add(moving(3, 0.04));  // too little to count as moved
  coverage.add(moving(1, 0.04));
  EXPECT_EQ(coverage.transitions(), 10);
  EXPECT_DOUBLE_EQ(coverage.figures().contact_share, 0.4);
  EXPECT_DOUBLE_EQ(coverage.figures().multi_body_share, 0.2);
}

/// Returns the share of transitions that move several, after one that moves all movable bodies.
double multi_body_share(const tasks::Task& task) {
  Transition t{task.start, 0, task.start, false, Source::kTree};
  for (std::size_t k = 1; k < task.scene.size(); ++k)
    if (!task.scene.bodies[k].fixed) t.next[k].y += 1.0;
  Coverage coverage(task);
  coverage.add(t);
  return coverage.figures().multi_body_share;
}

TEST(Coverage, WhatJointsConnectCountsAsOneButForWhatHangsOnAFixedBody) {
  tasks::Task task = testing::art_manip();
  EXPECT_EQ(multi_body_share(task), 0.0);
  task.scene.bodies[2].fixed = true;  // 1 hangs on it, and 3 with 4
  std::swap(task.scene.joints[0].parent, task.scene.joints[0].child);
  EXPECT_EQ(multi_body_share(task), 1.0);
}

TEST(Coverage, CountsWhereTransitionsComeFrom) {
  const tasks::Task task = gathering();
  Coverage coverage(task);
  Transition t = moving(0, 0.0);
  for (const Source source :
       {Source::kTree, Source::kBranch, Source::kBranch, Source::kWalk, Source::kForward}) {
    t.source = source;
    coverage.add(t);
  }
  EXPECT_EQ(coverage.figures().of(Source::kTree), 1);
  EXPECT_EQ(coverage.figures().of(Source::kBranch), 2);
  EXPECT_EQ(coverage.figures().of(Source::kWalk), 1);
  EXPECT_EQ(coverage.figures().of(Source::kForward), 1);
}

TEST(Coverage, HeadingsPerStateAreTransitionsOverDistinctStates) {
  const tasks::Task task = gathering();
  Coverage coverage(task);
  EXPECT_EQ(coverage.figures().headings_per_state, 0.0);
  Transition t = moving(0, 0.0);
  for (const int action : {1, 2, 3}) {
    t.action = action;
    coverage.add(t);
  }
  t.poses[0].x += 1e-9;  // another state
  coverage.add(t);
  EXPECT_DOUBLE_EQ(coverage.figures().headings_per_state, 4.0 / 2.0);
}

}  // namespace
}  // namespace rtg::search
