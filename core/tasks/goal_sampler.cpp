#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/tasks/task.hpp"
#include "core/world/separation.hpp"

namespace rtg {
namespace {

constexpr int kAttempts = 1000;
constexpr int kProposals = 50;         // per body and attempt
constexpr double kTighten = 0.05;      // what the goal is satisfied with to spare [m], [rad]
constexpr double kClearance = 0.0215;  // closer than 0.02 bodies are in contact for Box2D [m]
constexpr double kSlideError = 1e-3;   // [m]
constexpr double kBesideShare = 0.5;   // of the proposals that put a body beside another one
constexpr double kBesideGap = 0.1;     // ... at most so far from it [m]
constexpr double kBehindShare = 0.75;  // of the robots that stand as after a push
constexpr double kBehindGap =
    0.03;  // ... at most so far from what they pushed beyond the clearance [m]
constexpr double kFreeRange =
    3.0;  // a free robot is at most so far from a body (each coordinate) [m]
constexpr double kTwoPi = 2.0 * std::numbers::pi;

Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Bodies placed so far: `placed[i]` says whether `poses[i]` counts.
struct Layout {
  Poses poses;
  std::vector<bool> placed;
};

/// Least separation of body `i` at `pose` from all placed bodies.
double clearance(const Task& task, const Layout& layout, std::size_t i, const Pose& pose) {
  double least = 1e9;
  for (std::size_t j = 0; j < layout.poses.size(); ++j)
    if (j != i && layout.placed[j] && !jointed(task.scene, i, j))
      least = std::min(least, separation(task.scene.bodies[i].shape, pose,
                                         task.scene.bodies[j].shape, layout.poses[j]));
  return least;
}

/// A straight way of a body towards the placed ones.
struct Approach {
  Pose from;
  Vector2d heading;
  double gap = 0.0;    // left between them [m]
  double range = 0.0;  // its longest [m]
};

/// Where body `i` ends its approach, `gap` away from the first placed body; empty if it meets none
/// within `range`. The separating-axis gap never exceeds the distance, so no step passes through.
std::optional<Pose> slide(const Task& task, const Layout& layout, std::size_t i,
                          const Approach& way) {
  Pose pose = way.from;
  double gone = 0.0;
  while (gone < way.range) {
    const double free = clearance(task, layout, i, pose) - way.gap;
    if (free < kSlideError) return free > -kSlideError ? std::optional(pose) : std::nullopt;
    pose.x += free * way.heading.x();
    pose.y += free * way.heading.y();
    gone += free;
  }
  return std::nullopt;
}

/// x moved into the region of a term: anywhere in a disc, behind the line of a half-plane the
/// closer the likelier.
Vector2d moved_into(const GoalTerm& term, const Vector2d& x, Rng& rng) {
  if (term.region == GoalTerm::Region::kDisc) {
    const double r = (term.radius - kTighten) * std::sqrt(rng.uniform(0.0, 1.0));
    return term.centre + r * unit(rng.uniform(0.0, kTwoPi));
  }
  const double depth = term.offset - kTighten - term.normal.dot(x);
  return x + (depth - rng.uniform(0.0, 1.0) * std::abs(depth)) * term.normal;
}

Vector2d point_in_arena(const Task& task, Rng& rng) {
  const double a = task.push.arena;
  const double x = rng.uniform(-a, a);
  return {x, rng.uniform(-a, a)};
}

/// Whether every region that the centre of that body has to be in contains x, with room to spare.
bool in_target(const Task& task, std::size_t body, const Vector2d& x) {
  return std::ranges::all_of(task.goal, [&](const GoalTerm& term) {
    return term.subject != GoalTerm::Subject::kEvery || !concerns(term, task.scene, body) ||
           contains(term, x, kTighten);
  });
}

/// A point uniform in the arena, moved into the regions that the centre of body `i` has to be in.
Vector2d point_in_goal(const Task& task, std::size_t i, Rng& rng) {
  Vector2d x = point_in_arena(task, rng);
  for (const GoalTerm& term : task.goal)
    if (term.subject == GoalTerm::Subject::kEvery && concerns(term, task.scene, i))
      x = moved_into(term, x, rng);
  return x;
}

/// Angle of the outward normal of edge `k`, body frame.
double normal_angle(const Polygon& shape, std::size_t k) {
  const Vector2d edge = shape.vertices[(k + 1) % shape.size()] - shape.vertices[k];
  return std::atan2(-edge.x(), edge.y());
}

/// Body `i` slid towards a placed body from a random side: with equal odds face to face or at a
/// random angle.
std::optional<Pose> beside(const Task& task, const Layout& layout, std::size_t i, Rng& rng) {
  const auto j = static_cast<std::size_t>(1 + rng.below(static_cast<int>(task.scene.size()) - 1));
  if (j == i || !layout.placed[j]) return std::nullopt;
  const Polygon &mine = task.scene.bodies[i].shape, &other = task.scene.bodies[j].shape;
  double side = rng.uniform(0.0, kTwoPi), theta = rng.uniform(-std::numbers::pi, std::numbers::pi);
  if (rng.uniform(0.0, 1.0) < 0.5) {
    const auto theirs = static_cast<std::size_t>(rng.below(static_cast<int>(other.size())));
    const auto ours = static_cast<std::size_t>(rng.below(static_cast<int>(mine.size())));
    side = layout.poses[j].theta + normal_angle(other, theirs);
    theta = std::remainder(side + std::numbers::pi - normal_angle(mine, ours), kTwoPi);
  }
  const double reach = bounding_radius(mine) + bounding_radius(other) + kBesideGap;
  const double shift = rng.uniform(-0.5, 0.5) * bounding_radius(other);
  const Vector2d from =
      layout.poses[j].position() + reach * unit(side) + shift * unit(side + kTwoPi / 4.0);
  return slide(task, layout, i,
               {.from = {from.x(), from.y(), theta},
                .heading = -unit(side),
                .gap = rng.uniform(kClearance, kBesideGap),
                .range = 2.0 * reach});
}

bool place_object(const Task& task, Layout& layout, std::size_t i, Rng& rng) {
  for (int k = 0; k < kProposals; ++k) {
    std::optional<Pose> pose;
    if (rng.uniform(0.0, 1.0) < kBesideShare) {
      pose = beside(task, layout, i, rng);
    } else {
      const Vector2d x = point_in_goal(task, i, rng);
      pose = Pose{x.x(), x.y(), rng.uniform(-std::numbers::pi, std::numbers::pi)};
    }
    if (!pose || !in_target(task, i, pose->position())) continue;
    if (clearance(task, layout, i, *pose) < kClearance - kSlideError) continue;
    layout.poses[i] = *pose;
    layout.placed[i] = true;
    return true;
  }
  return false;
}

/// The angles of the joint within its limits and the goal; empty if there is none.
std::optional<std::pair<double, double>> angles_in_goal(const Task& task, const Joint& joint) {
  double least = std::isfinite(joint.lower) ? joint.lower : -std::numbers::pi;
  double most = std::isfinite(joint.upper) ? joint.upper : std::numbers::pi;
  for (const GoalTerm& term : task.goal) {
    if (!concerns(term, task.scene, joint)) continue;
    least = std::max(least, term.least + kTighten);
    most = std::min(most, term.most - kTighten);
  }
  if (least > most) return std::nullopt;
  return std::pair{least, most};
}

/// Takes the bodies of a tree of joints over from `poses` if all are in their regions and clear of
/// what is placed and of each other.
bool stand(const Task& task, Layout& layout, const Poses& poses, std::size_t root,
           std::span<const std::size_t> roots) {
  Layout trial = layout;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (roots[i] != root) continue;
    if (!task.scene.bodies[i].fixed &&
        (!in_target(task, i, poses[i].position()) ||
         clearance(task, trial, i, poses[i]) < kClearance - kSlideError))
      return false;
    trial.poses[i] = poses[i];
    trial.placed[i] = true;
  }
  layout = std::move(trial);
  return true;
}

/// Bodies that joints connect, as one: at random angles, then moved to where the root, or the
/// centroid that the goal speaks of, is in its region. A fixed root stays.
bool place_tree(const Task& task, Layout& layout, std::size_t root,
                std::span<const std::size_t> roots, Rng& rng) {
  const bool fixed = task.scene.bodies[root].fixed;
  for (int k = 0; k < kProposals; ++k) {
    Poses poses = layout.poses;
    if (!fixed) poses[root].theta = rng.uniform(-std::numbers::pi, std::numbers::pi);
    for (const std::size_t n : root_first(task.scene)) {
      const Joint& joint = task.scene.joints[n];
      const auto child = static_cast<std::size_t>(joint.child);
      if (roots[child] != root) continue;
      const auto angles = angles_in_goal(task, joint);
      if (!angles) return false;
      poses[child].theta = poses[static_cast<std::size_t>(joint.parent)].theta +
                           rng.uniform(angles->first, angles->second);
    }
    poses = with_closed_joints(task.scene, std::move(poses));
    if (!fixed) {
      Vector2d by = point_in_goal(task, root, rng) - poses[root].position();
      for (const GoalTerm& term : task.goal)
        if (term.subject == GoalTerm::Subject::kCentroid && concerns(term, task.scene, root))
          by = moved_into(term, point_in_arena(task, rng), rng) -
               centroid_of(term, task.scene, poses);
      for (std::size_t i = 1; i < poses.size(); ++i)
        if (roots[i] == root) poses[i] = {poses[i].x + by.x(), poses[i].y + by.y(), poses[i].theta};
    }
    if (stand(task, layout, poses, root, roots)) return true;
  }
  return false;
}

/// Where the robot ends a push along a random heading d(a) that ends with it behind a random
/// object.
std::optional<Pose> robot_behind(const Task& task, const Layout& layout, Rng& rng) {
  const auto j = static_cast<std::size_t>(1 + rng.below(static_cast<int>(task.scene.size()) - 1));
  const Vector2d d = direction(rng.below(task.push.headings), task.push);
  const double span =
      bounding_radius(task.scene.bodies[0].shape) + bounding_radius(task.scene.bodies[j].shape);
  const Vector2d from = layout.poses[j].position() - (span + task.push.stride) * d +
                        rng.uniform(-0.8, 0.8) * span * Vector2d(-d.y(), d.x());
  return slide(task, layout, 0,
               {.from = {from.x(), from.y(), task.start[0].theta},
                .heading = d,
                .gap = kClearance + rng.uniform(0.0, kBehindGap),
                .range = 2.0 * (span + task.push.stride)});
}

bool place_robot(const Task& task, Layout& layout, Rng& rng) {
  const bool behind = rng.uniform(0.0, 1.0) < kBehindShare;
  for (int k = 0; k < kProposals; ++k) {
    std::optional<Pose> pose;
    if (behind) {
      pose = robot_behind(task, layout, rng);
    } else {
      const auto j =
          static_cast<std::size_t>(1 + rng.below(static_cast<int>(task.scene.size()) - 1));
      pose = Pose{layout.poses[j].x + rng.uniform(-kFreeRange, kFreeRange),
                  layout.poses[j].y + rng.uniform(-kFreeRange, kFreeRange), task.start[0].theta};
    }
    if (!pose || !in_arena(*pose, task.push)) continue;
    if (clearance(task, layout, 0, *pose) < kClearance - kSlideError) continue;
    layout.poses[0] = *pose;
    return true;
  }
  return false;
}

bool place_objects(const Task& task, Layout& layout, Rng& rng) {
  const std::vector<std::size_t> roots = roots_of(task.scene);
  for (std::size_t i = 1; i < task.scene.size(); ++i) {
    if (roots[i] != i) continue;
    const bool alone = std::ranges::count(roots, i) == 1;
    if (alone && task.scene.bodies[i].fixed) continue;
    if (alone ? !place_object(task, layout, i, rng) : !place_tree(task, layout, i, roots, rng))
      return false;
  }
  return true;
}

std::optional<Poses> attempt(const Task& task, Rng& rng) {
  Layout layout{task.start, std::vector<bool>(task.scene.size(), false)};
  for (std::size_t i = 1; i < task.scene.size(); ++i) layout.placed[i] = task.scene.bodies[i].fixed;
  if (!place_objects(task, layout, rng)) return std::nullopt;
  if (task.scene.size() > 1 && !place_robot(task, layout, rng)) return std::nullopt;
  for (const GoalTerm& term : task.goal)  // what concerns each alone holds since it was placed
    if (term.subject != GoalTerm::Subject::kEvery &&
        !holds(term, task.scene, layout.poses, kTighten))
      return std::nullopt;
  std::transform(layout.poses.begin(), layout.poses.end(), layout.poses.begin(), to_single);
  return layout.poses;
}

}  // namespace

std::optional<Poses> sample_goal(const Task& task, Rng& rng) {
  for (int k = 0; k < kAttempts; ++k)
    if (std::optional<Poses> poses = attempt(task, rng)) return poses;
  return std::nullopt;
}

}  // namespace rtg
