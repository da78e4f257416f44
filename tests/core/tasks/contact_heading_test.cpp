#include "core/tasks/contact_heading.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/gathering.hpp"

namespace rtg::tasks {
namespace {

/// Counts how often each heading is drawn.
std::array<int, 48> drawn(const Task& task, const Poses& state, int draws) {
  std::array<int, 48> counts{};
  Rng rng(3);
  for (int k = 0; k < draws; ++k)
    ++counts[static_cast<std::size_t>(contact_heading(task, state, rng))];
  return counts;
}

TEST(ContactHeading, PointsAtTheObjectsAndNowhereElse) {
  const Task task = testing::gathering();
  const auto counts = drawn(task, task.start, 3000);
  const double step = 2.0 * std::numbers::pi / 48.0;
  for (int a = 0; a < 48; ++a) {
    bool at_one = false;
    for (std::size_t k = 1; k < task.start.size(); ++k) {
      const Vector2d arm = task.start[k].position() - task.start[0].position();
      const double off =
          std::remainder(std::atan2(arm.y(), arm.x()) - a * step, 2.0 * std::numbers::pi);
      const double reach = std::asin(task.scene.bodies[k].shape.radius() / arm.norm());
      at_one = at_one || std::abs(off) < reach + 0.5 * step;
    }
    EXPECT_TRUE(at_one || counts[static_cast<std::size_t>(a)] == 0) << a;
  }
  EXPECT_GE(std::ranges::count_if(counts, [](int n) { return n > 0; }), 7) << "several per object";
}

TEST(ContactHeading, SeeksAllMovableObjectsAlikeAndNoFixedOne) {
  Task task = testing::gathering();
  const Poses cross{{0, 0, 0}, {6, 0, 0}, {0, 6, 0}, {-6, 0, 0}};
  task.scene.bodies[2].fixed = true;
  const auto counts = drawn(task, cross, 4000);
  const auto around = [&](int a) {
    int sum = 0;
    for (int k = a - 3; k <= a + 3; ++k) sum += counts[static_cast<std::size_t>((k + 48) % 48)];
    return sum;
  };
  EXPECT_NEAR(around(0), 2000, 150);
  EXPECT_EQ(around(12), 0);
  EXPECT_NEAR(around(24), 2000, 150);
}

// Half a heading's step, seen from 6 m, is 0.46 of the radius of the bounding circle. A strip of
// that half width holds 0.57 of its area, and of its radii, without regard to area, 0.74.
TEST(ContactHeading, AimsAtAllPointsOfTheBoundingCircleAlike) {
  Task task = testing::gathering();
  task.scene.bodies[2].fixed = task.scene.bodies[3].fixed = true;
  const auto counts = drawn(task, {{0, 0, 0}, {6, 0, 0}, {0, 6, 0}, {-6, 0, 0}}, 4000);
  EXPECT_NEAR(counts[0] / 4000.0, 0.57, 0.04);
}

}  // namespace
}  // namespace rtg::tasks
