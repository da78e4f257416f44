#include "core/energy/step_energy.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "core/energy/open_gaps.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::energy {
namespace {

using testing::derivative_error;
using testing::noise;
using testing::test_directions;
using testing::TouchingScene;

/// Poses before and after a sub-step in contact, with the normal forces before it and the poses one
/// sub-step earlier.
struct Step {
  VectorXd next, now, previous_forces, before;
  StepFrom from() const { return {now, previous_forces, &before}; }
};

/// p with its unknowns moved by d [dofs].
VectorXd moved(VectorXd p, const VectorXd& d) {
  p.head(d.size()) += d;
  return p;
}

/// Draws a step around `poses`, gaps at least 0.003: differences over 1e-6 are exact to 1e-7.
Step random_step(const StepEnergy& energy, const Poses& poses, Rng& rng) {
  for (;;) {
    const VectorXd now = moved(stacked(poses), noise(energy.dofs(), 1e-3, rng));
    const VectorXd next = moved(now, noise(energy.dofs(), 5e-3, rng));
    if (least_gap(energy, now) > 0.003 && least_gap(energy, next) > 0.003)
      return {next, now, energy.forces(now), moved(now, noise(energy.dofs(), 5e-3, rng))};
  }
}

void expect_exact_derivatives(const StepEnergy& energy, const Poses& poses) {
  Rng rng(1);
  const VectorXd origin = VectorXd::Zero(energy.dofs());
  for (int trial = 0; trial < 5; ++trial) {
    const Step s = random_step(energy, poses, rng);
    ASSERT_GT(s.previous_forces.maxCoeff(), 0.0);
    const auto value = [&](const VectorXd& d) {
      return VectorXd::Constant(1, energy.value(moved(s.next, d), s.from()));
    };
    const auto gradient = [&](const VectorXd& d) {
      return energy.model(moved(s.next, d), s.from()).gradient;
    };
    const StepEnergy::Model model = energy.model(s.next, s.from());
    const auto directions = test_directions(model.gradient, rng);
    EXPECT_LT(derivative_error(value, model.gradient.transpose(), origin, directions), 1e-8);
    EXPECT_LT(derivative_error(gradient, model.hessian, origin, directions), 1e-6);
    EXPECT_LT((model.hessian - model.hessian.transpose()).norm(), 1e-12);
  }
}

TEST(StepEnergy, DerivativesMatchDifferences) {
  const TouchingScene scene;
  expect_exact_derivatives(scene.energy, scene.poses);
}

TEST(StepEnergy, DerivativesOfRoundAndCompoundBodiesMatchDifferences) {
  const testing::RoundScene scene;
  expect_exact_derivatives(scene.energy, scene.poses);
}

TEST(StepEnergy, DerivativesOfThePapersFormMatchDifferences) {
  TouchingScene scene;
  scene.physics.plain_barrier = scene.physics.periodic_turns = true;
  scene.physics.skin = 0.004;
  expect_exact_derivatives(StepEnergy(scene.scene, scene.physics, scene.task.push), scene.poses);
}

TEST(StepEnergy, DerivativesWithInertiaMatchDifferences) {
  testing::CoastingScene scene;
  expect_exact_derivatives(scene.energy, scene.poses);
  scene.physics.periodic_turns = true;
  scene.update();
  expect_exact_derivatives(scene.energy, scene.poses);
}

/// Forces and torques about the origin of all bodies, summed.
Vector3d net_wrench(const VectorXd& gradient, const VectorXd& p) {
  Vector3d net = Vector3d::Zero();
  for (Eigen::Index i = 0; i < gradient.size(); i += 3) {
    net += gradient.segment<3>(i);
    net[2] += p[i] * gradient[i + 1] - p[i + 1] * gradient[i];
  }
  return net;
}

TEST(StepEnergy, ContactForcesAreActionAndReaction) {
  const TouchingScene scene;
  Rng rng(2);
  const Step s = random_step(scene.energy, scene.poses, rng);
  VectorXd contact = scene.energy.model(s.next, {s.now, s.previous_forces}).gradient;
  for (int i = 0; i < scene.energy.bodies(); ++i) {  // less damping
    const Damping<double>& body = scene.energy.damping(i);
    const Vector3d moved = (s.next - s.now).segment<3>(3 * i);
    contact.segment<3>(3 * i) -= Vector3d(body.mass, body.mass, body.moment).cwiseProduct(moved);
  }
  EXPECT_GT(contact.norm(), 1e-3);
  EXPECT_LT(net_wrench(contact, s.next).norm(), 1e-15);
}

VectorXd rigidly_moved(VectorXd p, double angle, const Vector2d& shift) {
  for (Eigen::Index i = 0; i < p.size(); i += 3) {
    p.segment<2>(i) = rotate(angle, p.segment<2>(i)) + shift;
    p[i + 2] += angle;
  }
  return p;
}

TEST(StepEnergy, DoesNotChangeWithARigidMotionOfTheScene) {
  const TouchingScene scene;
  Rng rng(3);
  const Step s = random_step(scene.energy, scene.poses, rng);
  const Vector2d shift(4.0, -3.0);
  const VectorXd next = rigidly_moved(s.next, 2.2, shift), now = rigidly_moved(s.now, 2.2, shift);
  EXPECT_LT((scene.energy.forces(now) - s.previous_forces).norm(), 1e-12);
  EXPECT_NEAR(scene.energy.value(next, {now, s.previous_forces}),
              scene.energy.value(s.next, {s.now, s.previous_forces}), 1e-14);
  const VectorXd gradient = scene.energy.model(s.next, {s.now, s.previous_forces}).gradient;
  EXPECT_LT((scene.energy.model(next, {now, s.previous_forces}).gradient -
             rigidly_moved(gradient, 2.2, Vector2d::Zero()) +
             VectorXd::NullaryExpr(9, [](Eigen::Index m) { return m % 3 == 2 ? 2.2 : 0.0; }))
                .norm(),
            1e-12);
}

// Two bodies far apart: Ψ = ½ m |Δt|² + ½ J Δθ², in units of k_D/Δt².
TEST(StepEnergy, FreeBodiesAreDampedAlone) {
  const TouchingScene scene;
  const VectorXd now = stacked({{0, 0, 0}, {5, 0, 0}, {0, 5, 0}});
  VectorXd next = now;
  next.segment<3>(3) += Vector3d(0.3, -0.4, 0.2);
  const Mass box = mass_of(scene.scene.bodies[1]);
  const VectorXd previous_forces = scene.energy.forces(now);
  EXPECT_EQ(previous_forces, VectorXd::Zero(previous_forces.size()));
  EXPECT_NEAR(scene.energy.value(next, {now, previous_forces}),
              0.5 * box.mass * 0.25 + 0.5 * box.moment * 0.04, 1e-15);
  const VectorXd gradient = scene.energy.model(next, {now, previous_forces}).gradient;
  EXPECT_LT(
      (gradient.segment<3>(3) - Vector3d(0.3 * box.mass, -0.4 * box.mass, 0.2 * box.moment)).norm(),
      1e-15);
}

// ... and with inertia + ½ ι m |Δt - Δt₋|² + ½ ι J (Δθ - Δθ₋)², ι = 1/k_D.
TEST(StepEnergy, InertiaIsMeasuredFromTheMotionBefore) {
  testing::CoastingScene scene;
  scene.physics.damping = 0.5;
  scene.update();
  const VectorXd now = stacked({{0, 0, 0}, {5, 0, 0}, {0, 5, 0}});
  VectorXd next = now, before = now;
  next.segment<3>(3) += Vector3d(0.3, -0.4, 0.2);
  before.segment<3>(3) -= Vector3d(0.2, 0.1, 0.3);
  const Mass box = mass_of(scene.scene.bodies[1]);
  const VectorXd previous_forces = scene.energy.forces(now);
  const double damping = 0.5 * box.mass * 0.25 + 0.5 * box.moment * 0.04;
  EXPECT_NEAR(scene.energy.value(next, {now, previous_forces, &before}),
              damping + 2.0 * (0.5 * box.mass * 0.26 + 0.5 * box.moment * 0.01), 1e-15);
  EXPECT_NEAR(scene.energy.value(next, {now, previous_forces}), 3.0 * damping, 1e-15);  // from rest
}

// The paper's form: J (1 - cos a) + ι J (3 - 2 cos a - 2 cos b + cos(a + b)).
TEST(StepEnergy, PeriodicTurnsAreThoseOfDampingAndOfInertia) {
  testing::CoastingScene scene;
  scene.physics.damping = 0.5;
  scene.physics.periodic_turns = true;
  scene.update();
  const VectorXd now = stacked({{0, 0, 0}, {5, 0, 0}, {0, 5, 0}});
  VectorXd next = now, before = now;
  next[5] += 0.2;
  before[5] -= 0.3;
  const double turn = 3.0 - 2.0 * std::cos(0.2) - 2.0 * std::cos(0.3) + std::cos(0.5);
  const double expected =
      (1.0 - std::cos(0.2) + 2.0 * turn) * mass_of(scene.scene.bodies[1]).moment;
  EXPECT_NEAR(scene.energy.value(next, {now, scene.energy.forces(now), &before}), expected, 1e-14);
}

TEST(StepEnergy, EveryVertexMayTouchEveryOtherBody) {
  const TouchingScene scene;  // a hexagon and two boxes
  EXPECT_EQ(scene.energy.contacts().size(), 2u * 6u + 4u * 4u);
  for (const Contact& c : scene.energy.contacts()) {
    EXPECT_NE(c.body, c.other);
    EXPECT_DOUBLE_EQ(c.friction, 0.5);
  }
}

// A disc has one; so has a T six, and a part of it, each against every part of the other.
TEST(StepEnergy, TipsOfPartsTouchPartsOfOtherBodies) {
  const testing::RoundScene scene;
  EXPECT_EQ(scene.energy.contacts().size(), (1u * 2u + 6u) + (1u + 4u) + (6u + 2u * 4u));
}

TEST(StepEnergy, ConvertsUnitsAndBoundsOnce) {
  const TouchingScene scene;
  const PhysicsConfig& physics = scene.physics;
  const double unit = physics.damping / (physics.time_step * physics.time_step);
  EXPECT_DOUBLE_EQ(scene.energy.barrier().weight, physics.barrier / unit);
  EXPECT_DOUBLE_EQ(scene.energy.stride(), 0.2);
  // The hexagon's area is 3√3/2 r².
  const double drag = 1.5 * std::numbers::sqrt3 * 0.64 * 0.2;
  EXPECT_NEAR(scene.energy.control_bound()[0], physics.force_factor * drag, 1e-12);
  EXPECT_NEAR(scene.energy.control_bound()[1], physics.force_factor * drag, 1e-12);
  EXPECT_NEAR(scene.energy.control_bound()[2], physics.torque_factor * drag * 0.8, 1e-12);
}

// A body that a force brings from rest to push speed in one sub-step needs 1/k_D more of it.
TEST(StepEnergy, BoundsAllowForInertia) {
  const TouchingScene slow;
  const testing::CoastingScene scene;
  const double share = 1.0 + 1.0 / scene.physics.damping;
  for (int m = 0; m < 3; ++m)
    EXPECT_NEAR(scene.energy.control_bound()[m], share * slow.energy.control_bound()[m], 1e-12);
}

TEST(StepEnergy, ForcesAreThoseOfTheBarrierAtTheGap) {
  const TouchingScene scene;
  // Face to face 0.05 apart, the upper box shifted by 0.4: two vertices of each above the other.
  const VectorXd p = stacked({{-5, 0, 0}, {0, 0, 0}, {0.4, 1.25, 0}});
  const VectorXd forces = scene.energy.forces(p);
  int acting = 0;
  for (std::size_t k = 0; k < scene.energy.contacts().size(); ++k) {
    const double force = forces[static_cast<Eigen::Index>(k)];
    if (force == 0.0) continue;
    ++acting;
    EXPECT_NEAR(force, scene.energy.barrier().force(0.05), 1e-8);
  }
  EXPECT_EQ(acting, 2);
}

TEST(StepEnergy, OverlapHasInfiniteEnergy) {
  const TouchingScene scene;
  const VectorXd p = stacked({{0, 0, 0}, {1.3, 0, 0}, {5, 0, 0}});
  EXPECT_EQ(scene.energy.value(p, {p, VectorXd::Zero(28)}), INFINITY);
}

TEST(StepEnergy, GapsAreDistancesLessTheSkinWithinTheRange) {
  TouchingScene scene;
  scene.physics.skin = 0.004;
  const StepEnergy energy(scene.scene, scene.physics, scene.task.push);
  Rng rng(4);
  int within = 0, beyond = 0;
  for (int trial = 0; trial < 200; ++trial) {
    VectorXd p = stacked(scene.poses);
    p.segment<3>(3) << rng.uniform(1.0, 2.0), rng.uniform(-1.0, 1.0), rng.uniform(-3.0, 3.0);
    const Poses poses = unstacked(p);
    for (const Contact& c : energy.contacts()) {
      const Vector2d vertex =
          scene.scene.bodies[c.body].shape.parts()[0].core.vertices[static_cast<std::size_t>(
              c.vertex)];
      const HalfPlanes planes = half_planes(scene.scene.bodies[c.other].shape.parts()[0].core);
      const double gap = signed_distance(planes, scene.physics.sharpness,
                                         to_local(poses[c.other], to_world(poses[c.body], vertex)))
                             .value -
                         0.004;
      const double value = energy.gap_value(c, p), range = energy.barrier().range;
      if (gap < range) {
        EXPECT_NEAR(value, gap, 1e-12);
      } else {
        EXPECT_GE(value, range);
      }
      ++(gap < range ? within : beyond);
    }
  }
  EXPECT_GT(within, 100);
  EXPECT_GT(beyond, 100);
}

TEST(StepEnergy, PlainBarrierActsAtAnyDistance) {
  TouchingScene scene;
  scene.physics.plain_barrier = true;
  const StepEnergy energy(scene.scene, scene.physics, scene.task.push);
  const VectorXd far = stacked({{0, 0, 0}, {50, 0, 0}, {0, 80, 0}});
  const VectorXd forces = energy.forces(far);
  EXPECT_GT(forces.minCoeff(), 0.0);
  const double gap = energy.gap_value(energy.contacts()[0], far);
  EXPECT_DOUBLE_EQ(forces[0], energy.barrier().weight / gap);
}

TEST(StepEnergy, FixedBodiesTakePartWithoutCoordinates) {
  TouchingScene scene;
  scene.scene.bodies[2].fixed = true;
  const StepEnergy energy(scene.scene, scene.physics, scene.task.push);
  EXPECT_EQ(energy.dofs(), 6);
  EXPECT_EQ(energy.bodies(), 3);
  EXPECT_FALSE(energy.movable(2));
  expect_exact_derivatives(energy, scene.poses);
  // What the movable bodies feel is what they would feel from a movable one.
  const VectorXd p = stacked(scene.poses), forces = scene.energy.forces(p);
  EXPECT_EQ(energy.forces(p), forces);
  EXPECT_EQ(energy.model(p, {p, forces}).gradient,
            VectorXd(scene.energy.model(p, {p, forces}).gradient.head(6)));
}

TEST(StepEnergy, TwoFixedBodiesDoNotTouch) {
  TouchingScene scene;
  scene.scene.bodies[1].fixed = scene.scene.bodies[2].fixed = true;
  const StepEnergy energy(scene.scene, scene.physics, scene.task.push);
  for (const Contact& c : energy.contacts()) EXPECT_TRUE(c.body == 0 || c.other == 0);
  EXPECT_TRUE(energy.separated(stacked({{-5, 0, 0}, {0, 0, 0}, {0.1, 0, 0}})));
}

TEST(StepEnergy, PosesStackAndUnstack) {
  const TouchingScene scene;
  EXPECT_EQ(unstacked(stacked(scene.poses)), scene.poses);
  EXPECT_EQ(stacked({{1, 2, 3}, {4, 5, 6}}), (VectorXd{{1, 2, 3, 4, 5, 6}}));
}

}  // namespace
}  // namespace rtg::energy
