#include "core/search/forward_replay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/world/separation.hpp"

namespace rtg {
Poses float_rounded(const Poses& poses) {
  Poses out = poses;
  for (Pose& p : out) p = to_single(p);
  return out;
}

double replay_gap(const Poses& reverse_end, const Poses& replayed_end) {
  double sum = 0.0;
  for (std::size_t k = 0; k < reverse_end.size(); ++k)
    sum += (reverse_end[k].position() - replayed_end[k].position()).norm();
  return sum / static_cast<double>(reverse_end.size());
}

int objects_moved(const Poses& a, const Poses& b) {
  int count = 0;
  for (std::size_t k = 1; k < a.size(); ++k)
    count += (a[k].position() - b[k].position()).norm() > kMoved;
  return count;
}

double largest_turn(const Scene& scene, const Poses& a, const Poses& b) {
  double turn = 0.0;
  for (std::size_t k = 1; k < a.size(); ++k)
    if (!has_joint(scene, k)) turn = std::max(turn, std::abs(a[k].theta - b[k].theta));
  return turn;
}

bool legal_state(const Task& task, const Poses& poses) {
  return is_finite(poses) && in_arena(poses[0], task.push) &&
         !first_overlap(task.scene, poses).has_value();
}

std::vector<Predecessor> proposals(const Task& task, std::span<const ReverseJob> jobs,
                                 std::span<const ReverseResult> answers, SearchStats& stats) {
  std::vector<Predecessor> out;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    for (const Poses& exact : answers[k].starts) {
      Poses start = float_rounded(exact);
      if (!legal_state(task, start)) {
        ++stats.illegal_starts;
        continue;
      }
      const int moved = objects_moved(start, jobs[k].end);
      out.push_back({static_cast<int>(k), jobs[k].action, std::move(start), jobs[k].end, moved});
    }
  }
  return out;
}

std::vector<Predecessor> replay_candidates(const Task& task, std::vector<Predecessor> candidates,
                                         const ReplayBatch& replay, SearchStats& stats) {
  std::vector<ReplayJob> pushes;
  for (const Predecessor& c : candidates) pushes.push_back({c.start, c.action});
  const std::vector<ReplayResult> results = replay(pushes);
  std::vector<Predecessor> out;
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (!stats.count(results[k])) continue;
    Predecessor& c = candidates[k];
    c.gap = replay_gap(c.end, results[k].end);
    for (std::size_t body = 0; body < c.end.size(); ++body)
      c.miss = std::max(c.miss, (c.end[body].position() - results[k].end[body].position()).norm());
    c.end = results[k].end;
    c.moved = objects_moved(c.start, c.end);
    c.turn = largest_turn(task.scene, c.start, c.end);
    out.push_back(std::move(c));
  }
  return out;
}

std::vector<std::vector<Transition>> replay_chains(const Task& task, std::span<const Chain> chains,
                                                   const ReplayBatch& replay, SearchStats& stats) {
  std::vector<std::vector<Transition>> out(chains.size());
  std::vector<std::size_t> alive;
  for (std::size_t c = 0; c < chains.size(); ++c)
    if (!chains[c].actions.empty()) alive.push_back(c);
  for (std::size_t step = 0; !alive.empty(); ++step) {
    std::vector<ReplayJob> pushes;
    for (const std::size_t c : alive)
      pushes.push_back(
          {step == 0 ? chains[c].far_end : out[c].back().next, chains[c].actions[step]});
    const std::vector<ReplayResult> results = replay(pushes);
    std::vector<std::size_t> still;
    for (std::size_t k = 0; k < alive.size(); ++k) {
      if (!stats.count(results[k])) continue;
      const std::size_t c = alive[k];
      const bool success = succeeded(task, results[k].end);
      out[c].push_back(
          {pushes[k].start, pushes[k].action, results[k].end, success, Source::kChainReplay});
      if (!success && step + 1 < chains[c].actions.size()) still.push_back(c);
    }
    alive = std::move(still);
  }
  return out;
}

}  // namespace rtg
