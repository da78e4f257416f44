#include "core/reverse/reverse_simulator.hpp"

#include <utility>

#include "core/energy/open_gaps.hpp"
#include "core/reverse/merit_sqp.hpp"
#include "core/reverse/pruning.hpp"
#include "core/reverse/restoration.hpp"
#include "core/world/selection.hpp"

namespace rtg {
ReverseSimulator::ReverseSimulator(Scene scene, const PhysicsConfig& physics,
                                   const PushConfig& push, const ReverseConfig& config)
    : scene_(std::move(scene)), physics_(physics), push_(push), config_(config) {
  if (config.preset == ReversePreset::kPaper) physics_.plain_barrier = true;
}

ReverseResult ReverseSimulator::solve(const ReverseJob& job) const {
  ReverseResult result{SolveStatus::kNonFinite, 0, job.end, 0.0};
  if (job.end.size() != scene_.size() || !is_finite(job.end)) {
    result.start.assign(scene_.size(), Pose{});
    return result;
  }
  if (is_pruned(scene_, push_, job)) {
    result.status = SolveStatus::kPruned;
    return result;
  }
  return solve_legal(job);
}

ReverseResult ReverseSimulator::solve_legal(const ReverseJob& job) const {
  const std::vector<int> bodies = relevant_bodies(scene_, push_, job, physics_.range);
  const Selection part = select(scene_, job.end, bodies);
  const StepEnergy energy(part.scene, physics_, push_);
  const ReverseProblem problem{energy, config_, with_open_gaps(energy, stacked(part.poses)),
                               direction(job.action, push_), physics_.sub_steps};
  const SqpResult solved = config_.preset == ReversePreset::kPaper
                               ? merit_sqp(problem, static_iterate(problem))
                               : solve_with_restoration(problem);
  ReverseResult result{solved.status, solved.iterations, job.end, 0.0};
  if (!solved.x.p[0].allFinite()) {
    result.status = SolveStatus::kNonFinite;
    return result;
  }
  result.start = merged(job.end, unstacked(solved.x.p[0]), bodies);
  return result;
}

}  // namespace rtg
