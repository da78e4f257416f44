#pragma once

#include "core/tasks/task.hpp"

namespace rtg::tasks {

/// A single condition of a goal term in a state.
struct Atom {
  double excess = 0.0;     // how far it is from holding [m], [rad]; zero or less if it holds
  std::size_t body = 0;    // the body that it is about
  std::size_t second = 0;  // another one: the parent of a joint; else 0
};

/// Calls visit(atom) for each single condition of `term`: one per body, one per joint, or for the
/// mean one per body, all with the same excess. Allocates no memory, as searches test goals very
/// often.
template <class Visit>
void for_each_atom(const GoalTerm& term, const Task& task, const Poses& poses, Visit visit) {
  if (std::holds_alternative<JointIn>(term.condition)) {
    for (const Joint& joint : task.scene.joints)
      if (concerns(term, task.scene, joint))
        visit(Atom{excess(term, joint, poses), static_cast<std::size_t>(joint.child),
                   static_cast<std::size_t>(joint.parent)});
    return;
  }
  const auto* mean = std::get_if<MeanIn>(&term.condition);
  double of_mean = 0.0;
  if (mean) of_mean = excess(mean->region, centroid_of(term, task.scene, poses));
  if (term.negated) of_mean = -of_mean;
  for (std::size_t i = 1; i < poses.size(); ++i)
    if (concerns(term, task.scene, i))
      visit(Atom{mean ? of_mean : excess(term, task, poses, i), i});
}

}  // namespace rtg::tasks
