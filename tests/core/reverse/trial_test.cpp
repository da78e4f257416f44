#include "core/reverse/trial.hpp"

#include <gtest/gtest.h>

#include "tests/support/touching_scene.hpp"

namespace rtg {
namespace {

using testing::TouchingScene;

/// A trajectory at rest with two boxes 0.01 apart, and directions from it.
struct Trial {
  TouchingScene scene;
  ReverseConfig config;
  ReverseProblem problem{scene.energy, config, stacked({{-5, 0, 0}, {0, 0, 0}, {0.1, 1.21, 0}}),
                         Vector2d::UnitX(), 3};
  Iterate x = static_iterate(problem);

  Direction none() const {
    return {std::vector<VectorXd>(4, VectorXd::Zero(9)),
            std::vector<VectorXd>(4, VectorXd::Zero(x.forces[0].size())),
            std::vector<Vector3d>(4, Vector3d::Zero()),
            std::vector<VectorXd>(4, VectorXd::Zero(9))};
  }
  /// One coordinate of one pose alone.
  Direction coordinate(std::size_t level, int m, double size) const {
    Direction d = none();
    d.p[level][m] = size;
    return d;
  }
  std::optional<Iterate> operator()(const Direction& d, double alpha = 1.0) const {
    return trial_point(problem, x, d, alpha);
  }
};

TEST(TrialPoint, MovesEverythingByAlphaTimesTheDirection) {
  const Trial trial;
  Direction d = trial.none();
  Rng rng(1);
  for (std::size_t k = 0; k < 4; ++k) {
    d.p[k].head<3>() = testing::noise(3, 0.1, rng);
    d.forces[k] = testing::noise(d.forces[k].size(), 1.0, rng);
    d.controls[k] = testing::noise(3, 1.0, rng);
    d.multipliers[k] = testing::noise(9, 1.0, rng);
  }
  const auto moved = trial(d, 0.25);
  ASSERT_TRUE(moved);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(moved->p[k], trial.x.p[k] + 0.25 * d.p[k]);
    EXPECT_EQ(moved->forces[k], trial.x.forces[k] + 0.25 * d.forces[k]);
    EXPECT_EQ(moved->controls[k], Vector3d(trial.x.controls[k] + 0.25 * d.controls[k]));
    EXPECT_EQ(moved->multipliers[k], trial.x.multipliers[k] + 0.25 * d.multipliers[k]);
  }
}

TEST(TrialPoint, LongMovesTurnsAndNonsenseAreRefused) {
  const Trial trial;
  EXPECT_TRUE(trial(trial.coordinate(2, 0, 0.99)));
  EXPECT_FALSE(trial(trial.coordinate(2, 0, 1.01)));
  EXPECT_TRUE(trial(trial.coordinate(2, 0, 1.01), 0.5));
  EXPECT_TRUE(trial(trial.coordinate(2, 2, 0.49)));
  EXPECT_FALSE(trial(trial.coordinate(2, 2, -0.51)));
  EXPECT_FALSE(trial(trial.coordinate(0, 1, NAN)));
  EXPECT_FALSE(trial(trial.coordinate(3, 5, INFINITY)));
}

TEST(TrialPoint, GapsKeepATenthOfThemselves) {
  const Trial trial;
  EXPECT_TRUE(trial(trial.coordinate(1, 7, -0.0088)));
  EXPECT_FALSE(trial(trial.coordinate(1, 7, -0.0092)));
  EXPECT_FALSE(trial(trial.coordinate(1, 7, -0.02)));
  EXPECT_TRUE(trial(trial.coordinate(1, 7, 0.5)));
}

TEST(TrialPoint, BodiesMayNotCrossThoughTheirVerticesAreApart) {
  const Scene bars{{{"robot", "robot", box(2.0, 0.2), 1.0, 0.3, false},
                    {"bar", "bar", box(0.2, 2.0), 1.0, 0.3, false}}};
  const StepEnergy energy(bars, {}, {});
  const ReverseConfig config;
  const ReverseProblem problem{energy, config, stacked({{0, 0, 0}, {0.9, 1.3, 0}}),
                               Vector2d::UnitX(), 1};
  const Iterate x = static_iterate(problem);
  Direction d{std::vector<VectorXd>(2, VectorXd::Zero(6)),
              std::vector<VectorXd>(2, VectorXd::Zero(8)),
              std::vector<Vector3d>(2),
              {}};
  d.multipliers = d.p;
  d.controls.assign(2, Vector3d::Zero());
  d.p[0].tail<3>() = Vector3d(-0.4, -0.9, 0.0);  // from beside the bar's end onto its middle
  EXPECT_FALSE(trial_point(problem, x, d, 1.0));
  d.p[0].tail<3>() = Vector3d(0.4, -0.9, 0.0);  // past its end
  EXPECT_TRUE(trial_point(problem, x, d, 1.0));
}

TEST(TrialPoint, AForceThatIsAllButGoneIsGone) {
  const Trial trial;
  Direction d = trial.none();
  Eigen::Index contact = 0;
  const double force = trial.x.forces[1].maxCoeff(&contact);
  ASSERT_GT(force, 0.0);
  d.forces[1][contact] = -force * (1.0 - 1e-15);
  EXPECT_EQ(trial(d)->forces[1][contact], 0.0);
  d.forces[1][contact] = -force * (1.0 - 1e-9);
  EXPECT_GT(trial(d)->forces[1][contact], 0.0);
}

TEST(TrialPoint, ForcesOfThePaperFollowTheGaps) {
  Trial trial;
  trial.config = reverse_preset(ReversePreset::kPaper);
  Direction d = trial.coordinate(1, 7, 0.005);
  d.forces[1].setConstant(7.0);
  const auto moved = trial(d);
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->forces[1], trial.scene.energy.forces(moved->p[1]));
}

}  // namespace
}  // namespace rtg
