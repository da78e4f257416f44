// Which poses keep bodies apart.

#include <gtest/gtest.h>

#include <numbers>

#include "core/energy/step_energy.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::energy {
namespace {

/// Two bars that cross in their middles: no vertex of either is near the other.
Scene crossing_bars() {
  return {{{"robot", "robot", box(2.0, 0.2), 1.0, 0.3, false},
           {"bar", "bar", box(0.2, 2.0), 1.0, 0.3, false}}};
}

TEST(StepEnergyGaps, CrossingBarsAreRejectedThoughEveryGapIsOpen) {
  const StepEnergy energy(crossing_bars(), {}, {});
  const VectorXd crossed = VectorXd::Zero(6);
  for (const Contact& c : energy.contacts())
    EXPECT_GT(energy.gap_value(c, crossed), energy.barrier().range);
  EXPECT_FALSE(energy.separated(crossed));
  EXPECT_TRUE(std::isfinite(energy.value(crossed, {crossed, VectorXd::Zero(8)})));
  VectorXd apart = crossed;
  apart[3] = 1.2;
  EXPECT_TRUE(energy.separated(apart));
}

TEST(StepEnergyGaps, OneOverlapIsEnough) {
  Scene scene = crossing_bars();
  scene.bodies.push_back({"box", "box", box(1.0, 1.0), 1.0, 0.3, false});
  const StepEnergy energy(scene, {}, {});
  const Vector3d crossed(0.0, 0.0, 0.0), bar(0.0, 0.0, 0.0), far(5.0, 0.0, 0.0);
  const auto state = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    VectorXd p(9);
    p << a, b, c;
    return p;
  };
  EXPECT_TRUE(energy.separated(state({-5.0, 0.0, 0.0}, bar, far)));
  EXPECT_FALSE(energy.separated(state(crossed, bar, far)));
  EXPECT_FALSE(energy.separated(state({-5.0, 0.0, 0.0}, bar, {0.3, 0.0, 0.0})));
  EXPECT_FALSE(energy.separated(state({5.0, 0.2, 0.0}, bar, far)));
}

// Corners may overlap by what smoothing takes off them and as much again.
TEST(StepEnergyGaps, CornersMayOverlapByLittle) {
  const Polygon tip = regular_polygon(3, 1.0);  // one vertex at (1, 0), 60° wide
  const Scene scene{
      {{"robot", "robot", tip, 1.0, 0.3, false}, {"tip", "tip", tip, 1.0, 0.3, false}}};
  const StepEnergy energy(scene, {}, {});
  const auto tips = [](double overlap) {
    return stacked({{0, 0, 0}, {2.0 - overlap, 0, std::numbers::pi}});
  };
  EXPECT_TRUE(energy.separated(tips(0.08)));  // 0.08 m · cos 60° along the nearest normal
  EXPECT_FALSE(energy.separated(tips(0.14)));
}

// The signed distance of a point beyond a corner is less than its distance from the corner: two
// corners that face each other act on each other up to √2 of the range apart.
TEST(StepEnergyGaps, CornersActAsFarAsTheSignedDistanceSays) {
  const Scene scene{{{"robot", "robot", box(1.0, 1.0), 1.0, 0.5, false},
                     {"box", "box", box(1.0, 1.0), 1.0, 0.5, false}}};
  for (const double skin : {0.0, 0.06}) {
    PhysicsConfig physics;
    physics.skin = skin;
    const StepEnergy energy(scene, physics, {});
    for (const double gap : {0.1, 0.12, 0.13, 0.149}) {
      const double apart = 1.0 + skin + gap;  // of the centres, along either axis
      const VectorXd p = stacked({{0.0, 0.0, 0.0}, {apart, apart, 0.0}});
      const double corner = std::log(2.0) / physics.sharpness;  // that smoothing adds
      EXPECT_NEAR(energy.forces(p).maxCoeff(), energy.barrier().force(gap + corner), 1e-9);
      EXPECT_EQ(energy.forces(p).maxCoeff() > 0.0, gap + corner < physics.range);
    }
  }
}

}  // namespace
}  // namespace rtg::energy
