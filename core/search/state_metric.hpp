#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/search/ways.hpp"
#include "core/tasks/task.hpp"
#include "core/world/scene.hpp"

namespace rtg::search {

/// Distances between states, and a grid that groups similar states. Poses of an object that look
/// the same are equal here: angles count modulo the symmetry of its shape. An object with a joint
/// has no symmetry. The robot's angle is ignored, because no push changes it. So are fixed
/// bodies.
class StateMetric {
 public:
  explicit StateMetric(const Scene& scene);
  /// Knows the ways around the fixed bodies of the task, too, and the paces() of the bodies, all 1
  /// if there are none.
  explicit StateMetric(const tasks::Task& task, std::span<const double> paces = {});

  /// A body other than the robot that can move.
  struct Object {
    std::size_t body;
    bool jointed;
    double turn;        // Shape::symmetry(); 2π with a joint
    double pace = 1.0;  // of a push of it, rtg::paces()
  };
  std::span<const Object> objects() const { return objects_; }

  /// Returns |x_a - x_b| + r|θ_a - θ_b| of `object` [m], with r = 0.5 m. The turn is taken modulo
  /// Object::turn, to the least.
  double distance(const Object& object, const Poses& a, const Poses& b) const;

  /// Returns the shortest way of a body's centre from `a` to `b` around the fixed bodies; of an
  /// object also around gates, which hang on fixed bodies, where they are in the state `poses`. It
  /// is straight for bodies with joints, and for all if the constructor was given no task. Not
  /// thread-safe.
  Ways::Way way(std::size_t body, const Poses& poses, const Vector2d& a, const Vector2d& b) const;

  /// Returns the bodies that hang on fixed ones.
  std::span<const std::size_t> gates() const { return gates_; }

  /// Returns `poses` with a gate at the limit of its joint that is the farther one from its value
  /// in `target`, or a quarter turn from that value if there is no such limit.
  Poses opened(std::size_t gate, Poses poses, const Poses& target) const;

  /// Returns how much longer gates make the way() of `object` from where it is in `a` to where it
  /// is in `b` [m].
  double detour(const Object& object, const Poses& a, const Poses& b) const;

  /// Returns distance() with the length of the way() in the place of |x_a - x_b|.
  double distance_around(const Object& object, const Poses& a, const Poses& b) const;

  /// Returns the sum of distance() over all objects.
  double layout_distance(const Poses& a, const Poses& b) const;

  /// Returns the key of the grid cell of `poses`. A cell measures 0.8 m in the robot's x and y. It
  /// measures 0.4 m in each object's x and y, and about 0.4 rad in each object's angle.
  std::uint64_t cell(const Poses& poses) const;

 private:
  /// Returns the key of the grid cell of the objects alone, without the robot.
  std::uint64_t layout_cell(const Poses& poses) const;
  double turn_between(const Object& object, const Poses& a, const Poses& b) const;

  std::vector<Object> objects_;
  /// A body that does not keep to straight lines.
  struct Mover {
    double clearance = 0.0;                                // [m]
    std::vector<std::size_t> obstacles;                    // bodies
    Ways without_gates;                                    // around fixed bodies alone
    mutable std::unordered_map<std::uint64_t, Ways> ways;  // by the cells of the gates
  };
  std::vector<std::optional<Mover>> movers_;  // per body; empty if there is none
  std::vector<std::size_t> gates_;            // movable bodies that hang on fixed ones
  std::optional<tasks::Task> task_;
};

}  // namespace rtg::search
