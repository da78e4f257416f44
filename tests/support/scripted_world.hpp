#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/search/generate.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::testing {

/// All from the nominal start, no roll-outs. Goal states lie at any angles.
inline SearchConfig trees_only(int transitions, int depth) {
  SearchConfig config;
  config.transitions = transitions;
  config.explored = 1.0;
  config.rollout_share = 0.0;
  config.breadth = 8;
  config.depth = depth;
  config.turn_tolerance = 10.0;
  config.twins = 0;
  config.mended = 0.0;
  config.chain_share = 0.0;
  config.target_jitter = 0.0;
  config.evaluation_starts = 7;
  return config;
}

/// Gathering with a script for what reverse solves find and what pushes do, and notes of all that
/// was asked for. States are those of the start with the robot, or the first object, elsewhere.
struct ScriptedWorld {
  /// What a solve for `action` answers, right or wrong.
  struct Find {
    int action;
    Poses start;
  };

  Task task = gathering();
  std::vector<std::vector<Find>> layers;             // by batch of solves, from every node
  std::function<Poses(const Poses&, int)> pushed;    // what a push does
  std::vector<std::vector<ReverseJob>> solves = {};  // batches
  std::vector<std::vector<ReplayJob>> replays = {};
  std::vector<Transition> stored = {};
  std::vector<std::string> phases = {};  // of the progress

  /// The start with the robot `x` to the right and the first object `y` up [m].
  Poses start_but(double x, double y = 0.0) const {
    Poses poses = task.start;
    poses[0].x += x;
    poses[1].y += y;
    for (Pose& p : poses) p = to_single(p);
    return poses;
  }

  /// The goal state that was solved for first.
  const Poses& goal() const { return solves.front().front().end; }

  GenerationReport generation(const SearchConfig& config) {
    return generate(task, config, kSeed, seams());
  }
  static constexpr std::uint64_t kSeed = 1;

  /// Index of the first batch of pushes that begin in `starts`; -1: none does.
  long begun_in(std::span<const Poses> starts) const {
    const auto at = std::ranges::find_if(replays, [&](const std::vector<ReplayJob>& batch) {
      return std::ranges::equal(batch, starts, {}, &ReplayJob::start);
    });
    return at == replays.end() ? -1 : at - replays.begin();
  }

  /// Keys of generate(): 1 the exploration, 3 a wave that shows what serves, 4 the judgement of
  /// the trees, 5 a wave of roll-outs, 6 one of episodes to mend; of the exploration: 2 the target
  /// of a round.
  static Rng stream(std::uint64_t key, std::uint64_t number, std::uint64_t seed = kSeed) {
    return Rng(seed, key << 32 | number);
  }

 private:
  GenerationSeams seams() {
    GenerationSeams out;
    out.solve = [this](auto jobs) { return answers(jobs); };
    out.replay = [this](auto jobs) { return ends(jobs); };
    out.store = [this](auto rows) { stored.insert(stored.end(), rows.begin(), rows.end()); };
    out.progress = [this](const Progress& p) { phases.push_back(p.phase); };
    return out;
  }

  std::vector<ReverseResult> answers(std::span<const ReverseJob> jobs) {
    std::vector<ReverseResult> out(jobs.size(), {SolveStatus::kPruned});
    if (solves.size() < layers.size())
      for (const Find& find : layers[solves.size()])
        for (std::size_t k = 0; k < jobs.size(); ++k)
          if (jobs[k].action == find.action) out[k] = {SolveStatus::kConverged, 1, {find.start}};
    solves.emplace_back(jobs.begin(), jobs.end());
    return out;
  }

  std::vector<ReplayResult> ends(std::span<const ReplayJob> jobs) {
    replays.emplace_back(jobs.begin(), jobs.end());
    std::vector<ReplayResult> out;
    for (const ReplayJob& job : jobs)
      out.push_back({job.action == kSettle ? job.start : pushed(job.start, job.action), true, 0.0});
    return out;
  }
};

}  // namespace rtg::testing
