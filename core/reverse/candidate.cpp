#include "core/reverse/candidate.hpp"

#include <limits>

#include "core/energy/open_gaps.hpp"
#include "core/reverse/merit_sqp.hpp"
#include "core/reverse/pruning.hpp"
#include "core/reverse/restarts.hpp"

namespace rtg {
namespace {

/// How far a body exerts forces: the plain barrier at any distance.
double reach(const PhysicsConfig& physics) {
  return physics.plain_barrier ? std::numeric_limits<double>::infinity()
                               : physics.range + physics.skin;
}

}  // namespace

Candidate::Candidate(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push,
                     const ReverseConfig& config, const ReverseJob& job)
    : bodies_(relevant_bodies(scene, push, job, reach(physics))),
      part_(select(scene, job.end, bodies_)),
      energy_(part_.scene, physics, push),
      problem_{energy_, config, with_open_gaps(energy_, stacked(part_.poses)),
               direction(job.action, push), physics.sub_steps} {}

SqpResult Candidate::solve() const {
  SqpResult solved = problem_.config.preset == ReversePreset::kPaper
                         ? merit_sqp(problem_, static_iterate(problem_))
                         : solve_with_restarts(problem_);
  if (solved.status == SolveStatus::kConverged &&
      terminal_miss(problem_, solved.x) > problem_.config.terminal_tolerance)
    solved.status = SolveStatus::kInfeasible;
  return solved;
}

}  // namespace rtg
