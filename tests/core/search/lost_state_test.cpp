#include "core/search/lost_state.hpp"

#include <gtest/gtest.h>

#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

/// An episode whose state k has the robot at x = k.
Episode episode(bool success, std::vector<double> strayed) {
  Episode out;
  out.success = success;
  Poses poses = testing::gathering().start;
  for (std::size_t k = 0; k < strayed.size(); ++k) {
    poses[0].x = static_cast<double>(k);
    out.steps.push_back({poses, 0, poses});
  }
  out.used.assign(strayed.size(), 1);
  out.strayed = std::move(strayed);
  return out;
}

double robot_x(const std::vector<Episode>& episodes) {
  const std::optional<Poses> lost = lost_state(episodes);
  return lost ? (*lost)[0].x : -1.0;
}

TEST(LostState, IsTheFirstStateThatIsFarFromTheData) {
  EXPECT_EQ(robot_x({episode(false, {0.4, 0.9, 1.1, 0.5, 3.0})}), 2.0);
  EXPECT_EQ(robot_x({episode(false, {1.1, 0.0})}), 0.0);  // the start itself
}

TEST(LostState, IsOfTheFirstEpisodeThatGetsLostAndFails) {
  const Episode fails_nearby = episode(false, {0.9, 0.9});
  const Episode recovers = episode(true, {0.1, 5.0, 0.1});
  EXPECT_EQ(robot_x({fails_nearby, recovers, episode(false, {0.2, 0.2, 0.2, 2.0}),
                     episode(false, {2.0})}),
            3.0);
}

TEST(LostState, IsNoneWithoutSuchAnEpisode) {
  EXPECT_EQ(lost_state({}), std::nullopt);
  EXPECT_EQ(lost_state(std::vector{episode(true, {2.0}), episode(false, {1.0})}), std::nullopt);
}

TEST(LostState, StepsLongAfterItAreNotWorthKeeping) {
  const auto kept = [](const Episode& e) { return worth_keeping(e).size(); };
  const std::vector<double> lost_at_2{0.1, 0.1, 2.0, 0.1, 2.0, 2.0, 2.0, 2.0, 2.0};
  EXPECT_EQ(kept(episode(false, lost_at_2)), 2U + kAfter);
  EXPECT_EQ(kept(episode(true, lost_at_2)), 9U);
  EXPECT_EQ(kept(episode(false, {0.1, 2.0})), 2U);
  EXPECT_EQ(kept(episode(false, std::vector(30, 0.5))), 30U);
  EXPECT_EQ(kept(episode(false, {})), 0U);
  Episode at_random = episode(false, std::vector(30, 99.0));
  at_random.used.clear();
  EXPECT_EQ(kept(at_random), 30U);
  const Episode e = episode(false, lost_at_2);
  EXPECT_EQ(worth_keeping(e).data(), e.steps.data());
}

}  // namespace
}  // namespace rtg
