#include "core/search/stretch_probe.hpp"

#include <algorithm>
#include <utility>

namespace rtg {
namespace {

constexpr int kDraws = 5;  // per twin; those that are no legal state are drawn again
constexpr double kTurnPerMetre = 1.0 / 1.5;  // [rad/m]

/// Children turned back to where the limits of their joints end.
Poses within_limits(const Scene& scene, Poses poses) {
  for (const std::size_t k : root_first(scene)) {
    const Joint& joint = scene.joints[k];
    const double parent = poses[static_cast<std::size_t>(joint.parent)].theta;
    poses[static_cast<std::size_t>(joint.child)].theta =
        parent + std::clamp(joint_angle(joint, poses), joint.lower, joint.upper);
  }
  return poses;
}

}  // namespace

bool repeatable(const Predecessor& push, const SearchConfig& config) {
  return push.turn <= config.turn_tolerance && push.stretch <= config.stretch_tolerance;
}

StretchProbe::StretchProbe(const Task& task, const SearchConfig& config, std::uint64_t seed)
    : task_(task),
      config_(config),
      metric_(task.scene),
      movers_(movers_of(task.scene)),
      rng_(seed) {}

Poses StretchProbe::disturbed(Poses poses) {
  const double most = config_.twin_jitter;
  for (std::size_t body = 0; body < poses.size(); ++body) {
    if (task_.scene.bodies[body].fixed) continue;
    if (movers_[body] == body) {
      poses[body].x += rng_.uniform(-most, most);
      poses[body].y += rng_.uniform(-most, most);
    }
    const auto together = static_cast<double>(std::ranges::count(movers_, movers_[body]));
    const double turn = kTurnPerMetre / together * most;
    if (body > 0) poses[body].theta += rng_.uniform(-turn, turn);
  }
  return float_rounded(with_closed_joints(task_.scene, within_limits(task_.scene, poses)));
}

std::vector<StretchProbe::Twin> StretchProbe::draw(std::span<const Predecessor> candidates) {
  std::vector<Twin> twins;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Predecessor& c = candidates[k];
    const bool missed = c.miss > config_.gap_tolerance && !succeeded(task_, c.end);
    if (missed || c.turn > config_.turn_tolerance) continue;
    int left = config_.twins;
    for (int draws = 0; left > 0 && draws < kDraws * config_.twins; ++draws) {
      Poses start = disturbed(c.start);
      if (!legal_state(task_, start)) continue;
      twins.push_back({k, std::move(start)});
      --left;
    }
  }
  return twins;
}

void StretchProbe::measure(std::span<Predecessor> candidates, const ReplayBatch& replay,
                           SearchStats& stats) {
  const std::vector<Twin> twins = draw(candidates);
  std::vector<ReplayJob> pushes;
  for (const Twin& t : twins) pushes.push_back({t.start, candidates[t.of].action});
  const std::vector<ReplayResult> results = replay(pushes);
  std::vector<double> before(candidates.size(), 0.0), after(candidates.size(), 0.0);
  for (std::size_t k = 0; k < twins.size(); ++k) {
    if (!stats.count(results[k])) continue;
    const Predecessor& c = candidates[twins[k].of];
    before[twins[k].of] += metric_.distance(twins[k].start, c.start);
    after[twins[k].of] += metric_.distance(results[k].end, c.end);
  }
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (before[k] > 0.0) candidates[k].stretch = after[k] / before[k];
}

}  // namespace rtg
