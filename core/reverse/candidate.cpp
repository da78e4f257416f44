#include "core/reverse/candidate.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/energy/open_gaps.hpp"
#include "core/math/assembled_solver.hpp"
#include "core/math/riccati.hpp"
#include "core/reverse/pruning.hpp"
#include "core/reverse/sqp/filter_sqp.hpp"
#include "core/reverse/sqp/merit_sqp.hpp"
#include "core/world/pace.hpp"

namespace rtg::reverse {
namespace {

/// Returns the distance up to which a body exerts contact forces [m]: infinite with the plain
/// barrier.
double reach(const PhysicsConfig& physics) {
  return physics.plain_barrier ? std::numeric_limits<double>::infinity()
                               : physics.range + physics.skin;
}

/// Runs FilterSqp on problems of equal structure (structure_of()). Solves several in parallel, one
/// per SIMD lane, if `kkt` is kBlockElimination and the final state is not fixed.
std::vector<SqpResult> filter_sqp(std::span<const ReverseProblem* const> problems) {
  const ReverseProblem& like = *problems[0];
  const ReverseConfig& config = like.config;
  const bool fixed_end = config.terminal_weight == 0.0;
  if (config.kkt == KktMethod::kBlockElimination && !fixed_end)
    return FilterSqp<Lanes>(like, std::make_unique<Riccati<Lanes>>(like.energy.scene().movable(),
                                                                   like.sub_steps))
        .solve(problems);
  return FilterSqp<double>(like, std::make_unique<AssembledSolver>(config.kkt, fixed_end))
      .solve(problems);
}

/// Returns the stride, the number of coordinates of a scene and the numbers of parts of its bodies,
/// followed by its joints. Only candidates for which these are equal can share a solver.
std::vector<int> structure_of(const Candidate& candidate) {
  const energy::StepEnergy& energy = candidate.problem().energy;
  std::vector<int> structure{candidate.stride(), energy.dofs(), energy.bodies()};
  const std::vector<int>& parts = energy.scene().parts();
  structure.insert(structure.end(), parts.begin(), parts.end());
  for (const energy::JointModel<double>& joint : energy.scene().articulation().joints())
    structure.insert(structure.end(), {joint.parent, joint.child, static_cast<int>(joint.type)});
  return structure;
}

/// Groups candidates by structure and runs FilterSqp once per group.
std::vector<SqpResult> filter_sqp_of_all(std::span<const Candidate* const> candidates) {
  std::map<std::vector<int>, std::vector<std::size_t>> alike;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    alike[structure_of(*candidates[k])].push_back(k);
  std::vector<SqpResult> results(candidates.size());
  for (const auto& [structure, members] : alike) {
    std::vector<const ReverseProblem*> group;
    for (const std::size_t k : members) group.push_back(&candidates[k]->problem());
    std::vector<SqpResult> solved = filter_sqp(group);
    for (std::size_t n = 0; n < members.size(); ++n) results[members[n]] = std::move(solved[n]);
  }
  return results;
}

}  // namespace

Candidate::Candidate(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push,
                     const ReverseConfig& config, const ReverseJob& job)
    : bodies_(
          relevant_bodies(scene, push, job,
                          reach(physics) + physics.inertia_weight() * stride_of(job.action, push) /
                                               physics.sub_steps)),
      stride_(stride_index(job.action, push)),
      subscene_(select(scene, job.end, bodies_)),
      energy_(subscene_.scene, physics, with_stride_of(job.action, push)),
      problem_{energy_,
               config,
               with_open_gaps(energy_, energy::stacked(subscene_.poses)),
               direction(job.action, push),
               physics.sub_steps + physics.settling_steps(),
               physics.settling_steps()} {
  // Without its penalty the path does not hold the robot.
  if (config.path_weight > 0.0) problem_.pace = std::ranges::min(paces(subscene_.scene, physics));
}

std::vector<SqpResult> solve_together(std::span<const Candidate* const> candidates) {
  if (candidates.empty()) return {};
  const ReverseConfig& config = candidates[0]->problem().config;
  if (config.preset == ReversePreset::kDefault) return filter_sqp_of_all(candidates);
  std::vector<SqpResult> results;
  for (const Candidate* one : candidates)
    results.push_back(merit_sqp(one->problem(), static_iterate(one->problem())));
  return results;
}

}  // namespace rtg::reverse
