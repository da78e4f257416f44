#include "train/bindings/state_defect.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "core/world/separation.hpp"

namespace rtg::bindings {
namespace {

std::string in_words(double number) {
  std::ostringstream words;
  words << number;
  return words.str();
}

std::string in_words(const Pose& pose, double metre) {
  return '(' + in_words(pose.x / metre) + " m, " + in_words(pose.y / metre) + " m, " +
         in_words(pose.theta) + " rad)";
}

bool off_place(const Pose& pose, const Pose& place) {
  constexpr double kOff = 1e-4;  // more than single precision explains [m, rad]
  const double turn = std::remainder(pose.theta - place.theta, 2.0 * std::numbers::pi);
  return std::max({std::abs(pose.x - place.x), std::abs(pose.y - place.y), std::abs(turn)}) > kOff;
}

}  // namespace

std::string place_defect(const tasks::Task& task, const Poses& poses) {
  const double metre = task.units.metre();
  PushConfig around = task.push;
  around.arena *= 2.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Body& body = task.scene.bodies[i];
    const auto at = [&] { return "'" + body.name + "' at " + in_words(poses[i], metre); };
    if (body.fixed && off_place(poses[i], task.start[i]))
      return "the fixed body " + at() + " instead of " + in_words(task.start[i], metre);
    if (!body.fixed && !in_arena(poses[i], around)) return at() + ", out of twice the arena";
  }
  return "";
}

std::string state_defect(const tasks::Task& task, const Poses& poses) {
  constexpr double kDeep = 0.03;  // beyond what simulators let bodies overlap [m]
  if (!is_finite(poses)) return "numbers that are not finite";
  if (std::string defect = place_defect(task, poses); !defect.empty()) return defect;
  const auto overlap = first_overlap(task.scene, poses, -kDeep);
  if (!overlap) return "";
  return "'" + task.scene.bodies[overlap->first].name + "' and '" +
         task.scene.bodies[overlap->second].name + "' overlap by more than " +
         in_words(kDeep * task.units.length) + " m";
}

}  // namespace rtg::bindings
