#include "core/search/push_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;

constexpr double kTolerance = 1e-6;  // single precision of numbers up to 2

/// Gathering with the robot at the origin, one box at (x, y) and the others out of reach.
Poses box_at(double x, double y) { return {{0, 0, 0}, {x, y, 0}, {-6, 6, 0}, {-6, -6, 0}}; }

std::vector<float> described(const Poses& state, int action = 0) {
  const Task task = gathering();
  const PushContact contact(task.scene, task.push, 0.0);
  std::vector<float> out(static_cast<std::size_t>(contact.size()), NAN);
  contact.describe(state, action, out);
  return out;
}

TEST(PushContact, CutIsHowFarTheRobotReachesIntoABox) {
  // The robot's corner comes to x = 0.8 + 2, the face of the box is at 3 - 0.6.
  const std::vector<float> out = described(box_at(3.0, 0.0));
  ASSERT_EQ(out.size(), 6U);
  EXPECT_NEAR(out[0], 0.4, kTolerance);
  for (std::size_t k = 1; k < out.size(); ++k) EXPECT_EQ(out[k], 0.0F);
}

TEST(PushContact, ABoxCloserByIsCutByHalfTheWidthsOfBoth) {
  // Sideways it would be free sooner than along the way.
  EXPECT_NEAR(described(box_at(1.5, 0.0))[0], std::sqrt(3.0) / 2.0 * 0.8 + 0.6, kTolerance);
}

TEST(PushContact, SideIsTheCutTimesHowFarTheBoxLiesToTheLeft) {
  EXPECT_NEAR(described(box_at(3.0, 0.3))[3], 0.4 * 0.3, kTolerance);
  EXPECT_NEAR(described(box_at(3.0, -0.3))[3], -0.4 * 0.3, kTolerance);
}

TEST(PushContact, ABoxThatTheWayGrazesIsCutByItsEdge) {
  // The way is as wide as the hexagon, √3/2 · 0.8 to either side; the box reaches down to 1.2 -
  // 0.6.
  EXPECT_NEAR(described(box_at(1.5, 1.2))[0], std::sqrt(3.0) / 2.0 * 0.8 - 0.6, kTolerance);
}

TEST(PushContact, WhatTheRobotDoesNotMeetCountsNothing) {
  for (const Poses& state : {box_at(3.5, 0.0), box_at(1.5, 1.4), box_at(-1.5, 0.0)})
    for (const float x : described(state)) EXPECT_EQ(x, 0.0F);
}

TEST(PushContact, TheHeadingThatAContactLeavesDoesNotMatter) {
  Poses state = box_at(2.7, 0.4);
  const std::vector<float> expected = described(state, 3);
  state[0].theta = 1e-3;
  EXPECT_EQ(described(state, 3), expected);
}

TEST(PushContact, IsTheSameForATurnedScene) {
  const double turn = std::numbers::pi / 3.0;  // 8 of 48 headings
  Poses state = box_at(2.7, 0.4);
  state[1].theta = 0.3;
  const std::vector<float> expected = described(state, 3);
  for (Pose& p : state) {
    const Vector2d at = rotate(turn, p.position());
    p = {at.x(), at.y(), p.theta + turn};
  }
  const std::vector<float> turned = described(state, 11);
  EXPECT_GT(expected[0], 0.1F);
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(turned[k], expected[k], kTolerance);
}

}  // namespace
}  // namespace rtg
