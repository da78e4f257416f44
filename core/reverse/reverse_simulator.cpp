#include "core/reverse/reverse_simulator.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/reverse/candidate.hpp"
#include "core/reverse/pace.hpp"
#include "core/reverse/pruning.hpp"
#include "core/reverse/reverse_solution.hpp"

namespace rtg::reverse {
namespace {

// Least motion of an object, along x or y, and least turn for which predecessors() returns more
// than one start.
constexpr double kDragged = 0.05;  // [m]
constexpr double kTurned = 0.05;   // [rad]

constexpr double kFaster = 0.05;  // least change of its pace for which a problem is solved again

/// Returns whether `p` and `other` differ in the pose of any object, by at least kDragged in x or y
/// or by at least kTurned.
bool objects_differ(const VectorXd& p, const VectorXd& other) {
  for (Eigen::Index i = 3; i < p.size(); i += 3) {
    const Vector3d by = (other - p).segment<3>(i).cwiseAbs();
    if (std::max(by[0], by[1]) >= kDragged || by[2] >= kTurned) return true;
  }
  return false;
}

/// Returns the start of a quasi-static push p_0 ... p_h, and further starts from which the push
/// leads to the same end. In a further start the objects already have the poses that they have
/// after sub-step k. They rest there until the robot meets them, later in the push.
///
///   start_j = (robot of p_0, objects of p_k),  k = h·j/(n + 1),  j = 0 ... n = late_contacts
///
/// Without a load the robot advances by `ahead` [m] more per sub-step than at the pace of the
/// problem. In start_j it therefore stands farther back, by k·ahead.
///
/// With inertia, `late_contacts` must be 0.
///
/// Departs from the paper: a solve has one start there, that of the whole push. Of 300 true pushes
/// 278 are found with that one alone, 298 with seven more.
std::vector<VectorXd> predecessors(std::span<const VectorXd> p, int late_contacts,
                                   const Vector2d& ahead) {
  std::vector<VectorXd> out{p[0]};
  if (!objects_differ(p[0], p.back())) return out;
  std::size_t last = 0;
  for (int j = 1; j <= late_contacts; ++j) {
    const std::size_t k =
        (p.size() - 1) * static_cast<std::size_t>(j) / static_cast<std::size_t>(late_contacts + 1);
    if (k == std::exchange(last, k)) continue;  // fewer sub-steps than starts
    VectorXd start = p[k];
    start.head(3) = p[0].head(3);
    start.head(2) -= static_cast<double>(k) * ahead;
    out.push_back(std::move(start));
  }
  return out;
}

/// Solves the candidates together, first at the least pace of their bodies (paces()). Where that is
/// below 1, solves those again whose sustained_pace() is larger, and at pace 1 those that have no
/// predecessors.
///
/// At full pace alone, a body too heavy for it is dragged only as far as the robot gets ahead of
/// its path: the T of Push-T by 0.24 of the way of true pushes, with this by 0.99.
std::vector<SqpResult> solve_at_pace(std::span<Candidate* const> candidates) {
  std::vector<SqpResult> results =
      solve_together(std::vector<const Candidate*>(candidates.begin(), candidates.end()));
  std::vector<const Candidate*> faster;
  std::vector<std::size_t> where;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const ReverseProblem& problem = candidates[k]->problem();
    if (problem.pace + kFaster > 1.0) continue;
    const double pace =
        has_predecessors(results[k].status) ? sustained_pace(problem, results[k].x) : 1.0;
    if (pace < problem.pace + kFaster) continue;
    candidates[k]->set_pace(pace);
    faster.push_back(candidates[k]);
    where.push_back(k);
  }
  std::vector<SqpResult> again = solve_together(faster);
  for (std::size_t n = 0; n < where.size(); ++n) {
    again[n].iterations += results[where[n]].iterations;
    results[where[n]] = std::move(again[n]);
  }
  return results;
}

}  // namespace

ReverseSimulator::ReverseSimulator(const Scene& scene, const PhysicsConfig& physics,
                                   const PushConfig& push, const ReverseConfig& config)
    : model_(reverse_model(scene, physics, config)),
      push_(push),
      config_(config),
      newton_(physics.damping / (physics.time_step * physics.time_step)) {}

ReverseResult ReverseSimulator::solve(const ReverseJob& job) const {
  return std::move(solve(std::span(&job, 1)).front());
}

std::vector<ReverseResult> ReverseSimulator::solve(std::span<const ReverseJob> jobs) const {
  std::vector<ReverseResult> results(jobs.size());
  std::vector<std::unique_ptr<Candidate>> candidates(jobs.size());
  std::vector<Candidate*> legal;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (jobs[k].end.size() != model_.scene.size() || !is_finite(jobs[k].end)) continue;
    if (is_pruned(model_.scene, push_, jobs[k])) {
      results[k].status = SolveStatus::kPruned;
      continue;
    }
    candidates[k] =
        std::make_unique<Candidate>(model_.scene, model_.physics, push_, config_, jobs[k]);
    legal.push_back(candidates[k].get());
  }
  const std::vector<SqpResult> solved = solve_at_pace(legal);
  auto next = solved.begin();
  for (std::size_t k = 0; k < jobs.size(); ++k)
    if (candidates[k]) results[k] = answer(jobs[k], *candidates[k], *next++);
  return results;
}

ReverseResult ReverseSimulator::answer(const ReverseJob& job, const Candidate& candidate,
                                       const SqpResult& solved) const {
  ReverseResult result{solved.status, solved.iterations};
  if (job.with_solution) result.solution = solution_of(job, candidate, solved, newton_);
  if (!has_predecessors(result.status)) return result;
  const int late_contacts = model_.physics.inertia ? 0 : config_.late_contacts;
  const ReverseProblem& problem = candidate.problem();
  const Vector2d ahead = (1.0 - problem.pace) * problem.energy.stride() * problem.direction;
  for (const VectorXd& start : predecessors(solved.x.p, late_contacts, ahead))
    result.predecessors.push_back(merged(job.end, energy::unstacked(start), candidate.bodies()));
  return result;
}

}  // namespace rtg::reverse
