// How bodies turn in Box2D, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "core/forward/box2d_simulator.hpp"

namespace rtg::forward {
namespace {

/// A square with corners at the distance `reach` along the axes, so that one points to +x and one
/// to -x.
Polygon diamond(double reach) { return regular_polygon(4, reach); }

Scene frictionless(const Polygon& robot, const Polygon& object) {
  return {{{"robot", "robot", robot, 1.0, 0.0, false}, {"object", "box", object, 1.0, 0.0, false}}};
}

// Each impulse P of a corner on a face, without friction, changes the speed of a free body by P/m
// and its spin by -P t/I, t its lever. Damping takes the same share of both, so displacements have
// the proportion of impulses: dθ/dx = -m t/I. On the left face of a box of half width w a corner at
// the height y has t = y + w θ for small θ, hence θ = -y/w (1 - exp(-w m x/I)).
TEST(Box2dRotation, AnOffCentrePushTurnsABoxAsItsMomentOfInertiaSays) {
  const Scene scene = frictionless(diamond(0.5), box(1.2, 0.8));
  const Mass mass = mass_of(scene.bodies[1]);
  PushConfig push;
  push.strides = {0.04};
  for (const double y : {-0.3, 0.1, 0.2, 0.35}) {
    const Poses start{{0, y, 0}, {1.12, 0, 0}};
    const PushOutcome out = Box2dSimulator(scene, push, {}).push(start, 0);
    ASSERT_TRUE(out.ok);
    const double x = out.end[1].x - start[1].x;
    const double turn = -y / 0.6 * -std::expm1(-0.6 * mass.mass * x / mass.moment);
    EXPECT_GT(x, 0.02);
    EXPECT_NEAR(out.end[1].theta, turn, 0.01 * std::abs(turn)) << y;
  }
}

// A corner that does not give way turns the robot that is pressed against it where the torque of
// the largest force, B_f y, is more than B_ω: from y = torque_factor / force_factor · r₀ on.
TEST(Box2dRotation, TheTorqueBoundDecidesWhetherAFixedCornerTurnsTheRobot) {
  Scene scene = frictionless(box(1.0, 1.0), diamond(0.5));
  scene.bodies[1].fixed = true;
  const double radius = scene.bodies[0].shape.radius();
  for (const double torque_factor : {1.0, 2.0, 3.0}) {
    PhysicsConfig physics;
    physics.torque_factor = torque_factor;
    const double limit = torque_factor / physics.force_factor * radius;
    const auto turn = [&](double y) {
      const Poses start{{0, 0, 0}, {1.2, y, 0}};
      return Box2dSimulator(scene, {}, physics).push(start, 0).end[0].theta;
    };
    EXPECT_NEAR(turn(0.95 * limit), 0.0, 0.01) << torque_factor;
    EXPECT_GT(turn(1.05 * limit), 0.1) << torque_factor;
  }
}

}  // namespace
}  // namespace rtg::forward
