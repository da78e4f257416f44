#include "core/tasks/contact_placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/draws.hpp"
#include "core/world/separation.hpp"

namespace rtg::tasks {
namespace {

// Share of bodies that lie face to face with the one they are to touch, and with any other.
constexpr double kFaceShare = 0.8, kFaceShareOfAny = 0.5;
constexpr double kSlideError = 1e-3;  // largest error of that gap [m]
constexpr double kBesideGap = 0.1;    // largest gap to that body [m]
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Returns the angles of the outward normals of all straight edges of the parts, in the body frame.
std::vector<double> normal_angles(const Shape& shape) {
  std::vector<double> angles;
  for (const auto& [core, radius] : shape.parts())
    for (std::size_t k = 0; core.size() > 1 && k < core.size(); ++k) {
      const Vector2d edge = core.vertices[(k + 1) % core.size()] - core.vertices[k];
      angles.push_back(angle_of(edge.y(), -edge.x()));
    }
  return angles;
}

/// Proposes a pose of body `i` beside body `j`, which is placed. Body `i` slides towards that body
/// from a random side, face to face with the probability `face_share`, else at a random angle.
/// Returns nothing if slide() fails.
std::optional<Pose> beside(GoalDraw& draw, std::size_t i, std::size_t j, double face_share) {
  Rng& rng = draw.rng;
  const PartialState& state = draw.state;
  const Scene& scene = draw.task.scene;
  const Shape &mine = scene.bodies[i].shape, &other = scene.bodies[j].shape;
  const std::vector<double> ours = normal_angles(mine), theirs = normal_angles(other);
  double side = rng.uniform(0.0, kTwoPi), theta = rng.uniform(-std::numbers::pi, std::numbers::pi);
  if (rng.uniform(0.0, 1.0) < face_share && !ours.empty() && !theirs.empty()) {
    const auto one_of = [&rng](const std::vector<double>& angles) {
      return angles[static_cast<std::size_t>(rng.below(static_cast<int>(angles.size())))];
    };
    const double their = one_of(theirs), our = one_of(ours);
    side = state.poses[j].theta + their;
    theta = std::remainder(side + std::numbers::pi - our, kTwoPi);
  }
  const double reach = mine.radius() + other.radius() + kBesideGap;
  const double shift = rng.uniform(-0.5, 0.5) * other.radius();
  const Vector2d from =
      state.poses[j].position() + reach * unit(side) + shift * unit(side + kTwoPi / 4.0);
  return slide(draw.task, state, i,
               {.from = {from.x(), from.y(), theta},
                .heading = -unit(side),
                .gap = rng.uniform(kClearance, kBesideGap),
                .range = 2.0 * reach});
}

/// Returns whether `term` asks body `i` to touch bodies like body `j`.
bool asks_to_touch(const GoalTerm& term, const Scene& scene, std::size_t i, std::size_t j) {
  const auto* touches = std::get_if<Touches>(&term.condition);
  if (!touches || term.negated || i == j || j == 0 || !concerns(term, scene, i)) return false;
  const Body& other = scene.bodies[j];
  return touches->other == "*" ? !other.fixed : touches->other == other.kind;
}

/// Returns the placed bodies that a term asks body `i` to touch, or to touch body `i`, in random
/// order.
std::vector<std::size_t> to_touch(GoalDraw& draw, std::size_t i) {
  const Scene& scene = draw.task.scene;
  std::vector<std::size_t> found;
  for (const GoalTerm& term : draw.goal)
    for (std::size_t j = 1; j < scene.size(); ++j)
      if (draw.state.placed[j] &&
          (asks_to_touch(term, scene, i, j) || asks_to_touch(term, scene, j, i)))
        found.push_back(j);
  return drawn(found, static_cast<int>(found.size()), draw.rng);
}

/// Moves a pose of body `i` straight along `heading` until the body is kBesideGap / 2 from body
/// `k`.
Pose moved_up_to(const GoalDraw& draw, std::size_t i, Pose pose, const Vector2d& heading,
                 std::size_t k) {
  const Shape &mine = draw.task.scene.bodies[i].shape, &other = draw.task.scene.bodies[k].shape;
  for (int step = 0; step < kProposals; ++step) {
    const double free = separation(mine, pose, other, draw.state.poses[k]) - kBesideGap / 2.0;
    if (free < kSlideError) break;
    pose.x += free * heading.x();
    pose.y += free * heading.y();
  }
  return pose;
}

}  // namespace

std::optional<Pose> beside_any(GoalDraw& draw, std::size_t i) {
  const auto j =
      static_cast<std::size_t>(1 + draw.rng.below(static_cast<int>(draw.task.scene.size()) - 1));
  if (j == i || !draw.state.placed[j]) return std::nullopt;
  return beside(draw, i, j, kFaceShareOfAny);
}

bool is_to_touch(const GoalDraw& draw, std::size_t i) {
  const Scene& scene = draw.task.scene;
  return std::ranges::any_of(draw.goal, [&](const GoalTerm& term) {
    for (std::size_t j = 1; j < scene.size(); ++j)
      if (asks_to_touch(term, scene, i, j) ||
          (draw.state.placed[j] && asks_to_touch(term, scene, j, i)))
        return true;
    return false;
  });
}

std::optional<Pose> in_touch(GoalDraw& draw, std::size_t i) {
  const std::vector<std::size_t> others = to_touch(draw, i);
  if (others.empty()) return std::nullopt;
  const std::optional<Pose> pose = beside(draw, i, others[0], kFaceShare);
  if (!pose || others.size() == 1 || draw.rng.uniform(0.0, 1.0) < 0.2) return pose;
  const Vector2d to = draw.state.poses[others[1]].position() - pose->position();
  const double turn =
      pose->theta +
      std::round((angle_of(to.x(), to.y()) - pose->theta) / (kTwoPi / 4.0)) * (kTwoPi / 4.0);
  return moved_up_to(draw, i, *pose, unit(turn), others[1]);
}

}  // namespace rtg::tasks
