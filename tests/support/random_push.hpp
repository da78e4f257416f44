#pragma once

#include <cstdint>
#include <numbers>
#include <optional>

#include "core/math/rng.hpp"
#include "core/world/push.hpp"
#include "core/world/separation.hpp"

namespace rtg::testing {

/// A scene with a start and an action whose push meets at least one object.
struct RandomPush {
  Scene scene;
  Poses start;
  int action = 0;
};

/// A box, triangle, pentagon or hexagon about as large as Gathering's boxes.
inline Polygon random_shape(Rng& rng) {
  const int sides = 3 + rng.below(4);
  if (sides == 4) return box(rng.uniform(0.6, 1.6), rng.uniform(0.6, 1.6));
  return centred(regular_polygon(sides, rng.uniform(0.6, 1.0)));
}

/// A T, an L, a cross, a disc, or a polygon with round corners, of about the same size.
inline Shape random_compound(Rng& rng) {
  const double length = rng.uniform(1.2, 1.8), width = rng.uniform(0.3, 0.5);
  const int kind = rng.below(5);
  if (kind == 3) return Shape(disc(rng.uniform(0.5, 0.8)));
  if (kind == 4)
    return Shape(Part{regular_polygon(3 + rng.below(4), length / 3.0), rng.uniform(0.1, 0.3)});
  const Vector2d ends[] = {{0.0, length / 2.0 - width}, {length / 3.0, 0.0}, {0.0, 0.0}};
  std::vector<Part> parts = placed({{box(width, length)}}, 0.0, ends[kind]);
  parts.push_back({box(length, width)});
  return Shape(std::move(parts)).centred();
}

/// The robot and one to four objects around it, none closer to another than Box2D's skin; nothing
/// if the objects found no room or the robot's straight way misses them all.
inline std::optional<RandomPush> drawn_push(Rng& rng, const PushConfig& push, bool compound) {
  constexpr double kFriction = 0.5, kClearance = 0.02;
  RandomPush drawn;
  const Shape robot = compound ? Shape(disc(0.8)) : Shape(regular_polygon(6, 0.8));
  drawn.scene.bodies.push_back({"robot", "robot", robot, 1.0, kFriction, false});
  drawn.start.push_back({0.0, 0.0, rng.uniform(-std::numbers::pi, std::numbers::pi)});
  drawn.action = rng.below(push.headings);
  const int objects = 1 + rng.below(4);
  for (int k = 0; k < objects; ++k) {
    const Shape shape = compound ? random_compound(rng) : Shape(random_shape(rng));
    drawn.scene.bodies.push_back({"object", "box", shape, 1.0, kFriction, false});
    const double angle = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const Vector2d at = rotate(angle, {rng.uniform(1.0, 3.5), 0.0});
    drawn.start.push_back({at.x(), at.y(), rng.uniform(-std::numbers::pi, std::numbers::pi)});
  }
  if (first_overlap(drawn.scene, drawn.start, kClearance)) return std::nullopt;
  Poses ahead = drawn.start;
  for (int k = 1; k <= 4; ++k) {
    const Vector2d at = 0.25 * k * longest_stride(push) * direction(drawn.action, push);
    ahead[0] = {at.x(), at.y(), drawn.start[0].theta};
    const auto met = first_overlap(drawn.scene, ahead, 0.0);
    if (met && met->first == 0) return drawn;
  }
  return std::nullopt;
}

/// The push of that seed: of a hexagon among polygons, or of a disc among random_compound() bodies.
inline RandomPush random_push(std::uint64_t seed, const PushConfig& push, bool compound = false) {
  Rng rng(seed);
  for (;;)
    if (auto drawn = drawn_push(rng, push, compound)) return *drawn;
}

}  // namespace rtg::testing
