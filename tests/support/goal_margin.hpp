#pragma once

#include "core/tasks/task.hpp"

namespace rtg::testing {

/// Returns the term with its region or range of angles smaller by `margin` on each side.
inline tasks::GoalTerm with_margin(tasks::GoalTerm term, double margin) {
  if (auto* in = std::get_if<tasks::CentreIn>(&term.condition))
    in->region = inset(in->region, margin);
  if (auto* mean = std::get_if<tasks::MeanIn>(&term.condition))
    mean->region = inset(mean->region, margin);
  if (auto* joint = std::get_if<tasks::JointIn>(&term.condition)) {
    joint->least += margin;
    joint->most -= margin;
  }
  return term;
}

/// Returns whether the goal holds with that margin [m], [rad].
inline bool succeeded_with(const tasks::Task& task, const Poses& poses, double margin) {
  for (const tasks::GoalTerm& term : task.goal)
    if (!holds(with_margin(term, margin), task, poses)) return false;
  return true;
}

}  // namespace rtg::testing
