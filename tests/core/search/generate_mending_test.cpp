#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/search/roll_out.hpp"
#include "tests/support/scripted_world.hpp"

namespace rtg {
namespace {

using testing::ScriptedWorld;
using testing::trees_only;

constexpr int kFirst = 34, kLast = 36;  // actions; the robot pushes away from all objects
constexpr int kWave = 50;               // episodes
constexpr double kJitter = 0.1;         // of their starts [m]

/// Enough roll-outs to fill what trees and one wave of mended episodes leave.
SearchConfig one_wave() {
  SearchConfig config = trees_only(4 * kWave, 1);
  config.mended = 0.25;
  config.rollout_jitter = kJitter;
  config.rollout_noise = 0.0;
  return config;
}

/// The policy likes `kFirst` best. It solves the task where the first object lies to the right of
/// its nominal place; elsewhere it throws the robot off, and only `kLast` would have done.
struct AstrayWorld : ScriptedWorld {
  AstrayWorld() {
    task.horizon = 9;
    layers = {{{kFirst, task.start}, {kLast, start_but(0.5)}}};
    pushed = [this](Poses poses, int action) {
      if (action == kFirst && lies_right(poses)) return goal();
      if (action == kLast && (!is_thrown(poses) || poses == start_but(0.5))) return goal();
      if (action == kFirst) poses[0].x += 0.25;
      return poses;
    };
  }

  bool lies_right(const Poses& poses) const { return poses[1].x >= task.start[1].x; }
  bool is_thrown(const Poses& poses) const {
    return std::abs(poses[0].x - task.start[0].x) > 2.0 * kJitter;
  }

  std::vector<Poses> wave() const {
    Rng rng = stream(6, 0);
    return jittered_starts(task, kWave, kJitter, rng);
  }
  long waves() const {
    return std::ranges::count_if(
        phases, [](const std::string& phase) { return phase.starts_with("mending ("); });
  }
};

TEST(GenerateMending, WhatEpisodesFindAndWhatWouldHaveSavedTheOthersIsMended) {
  AstrayWorld world;
  EXPECT_EQ(world.generation(one_wave()).transitions, 4 * kWave);
  EXPECT_EQ(world.waves(), 1);
  std::vector<Transition> mended;
  std::ranges::copy_if(world.stored, std::back_inserter(mended),
                       [](const Transition& t) { return t.source == Source::kMended; });
  ASSERT_EQ(mended.size(), kWave);
  for (const Poses& start : world.wave()) {
    const auto t = std::ranges::find(mended, start, &Transition::poses);
    ASSERT_NE(t, mended.end());
    EXPECT_TRUE(t->success);
    EXPECT_EQ(t->action, world.lies_right(start) ? kFirst : kLast);
  }
}

TEST(GenerateMending, PlansAreSearchedFromTheStartAndAfterEightActions) {
  AstrayWorld world;
  world.generation(one_wave());
  const std::vector<Poses> wave = world.wave();
  const long begun = world.begun_in(wave);
  ASSERT_GE(begun, 0);
  std::vector<Poses> lost, searched;
  std::ranges::copy_if(wave, std::back_inserter(lost),
                       [&](const Poses& start) { return !world.lies_right(start); });
  ASSERT_GT(lost.size(), 10U);
  for (const ReplayJob& job : world.replays.at(static_cast<std::size_t>(begun + 9)))
    if (searched.empty() || job.start != searched.back()) searched.push_back(job.start);
  ASSERT_EQ(searched.size(), 2 * lost.size());
  for (std::size_t k = 0; k < lost.size(); ++k) {
    EXPECT_EQ(searched[2 * k], lost[k]);
    EXPECT_TRUE(world.is_thrown(searched[2 * k + 1]));
    EXPECT_EQ(searched[2 * k + 1][1], lost[k][1]);
  }
}

TEST(GenerateMending, EpisodesShorterThanThatAreSearchedFromTheStartAlone) {
  AstrayWorld world;
  world.task.horizon = 8;
  world.generation(one_wave());
  const long begun = world.begun_in(world.wave());
  ASSERT_GE(begun, 0);
  const auto& pushes = world.replays.at(static_cast<std::size_t>(begun + 8));
  EXPECT_TRUE(std::ranges::none_of(
      pushes, [&](const ReplayJob& job) { return world.is_thrown(job.start); }));
}

TEST(GenerateMending, WavesGoOnUntilEnoughIsFound) {
  AstrayWorld world;
  SearchConfig config = one_wave();
  config.mended = 0.75;
  world.generation(config);
  EXPECT_EQ(world.waves(), 3);
}

TEST(GenerateMending, AWaveThatFindsNothingIsTheLast) {
  AstrayWorld world;
  world.pushed = [&](const Poses& poses, int action) {
    return action == kFirst && poses == world.task.start ? world.goal() : poses;
  };
  const GenerationReport report = world.generation(one_wave());
  EXPECT_EQ(world.waves(), 1);
  EXPECT_EQ(std::ranges::count(world.stored, Source::kMended, &Transition::source), 0);
  EXPECT_EQ(report.transitions, 4 * kWave);
}

}  // namespace
}  // namespace rtg
