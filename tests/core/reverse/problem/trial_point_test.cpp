#include "core/reverse/problem/trial_point.hpp"

#include <gtest/gtest.h>

#include "tests/support/chain_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::TouchingScene;

/// A trajectory at rest in contact, and steps from it.
template <class TestScene>
struct TrialOf {
  TestScene scene;
  ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  ProblemLanes<double> lanes{problem};
  Trajectory<double> x{lanes.energy, problem.sub_steps}, moved = x;
  StageStep<double> step{scene.energy.scene().movable(), problem.sub_steps};
  PerContact<double> force_step = x.forces;

  TrialOf() {
    lanes.load(0, problem);
    x.load(0, problem, static_iterate(problem));
    moved = x;
    for (std::size_t k = 0; k < step.poses.size(); ++k) {
      for (Vec3<double>& block : step.poses[k]) block.setZero();
      for (Vec3<double>& block : step.multipliers[k]) block.setZero();
      step.controls[k].setZero();
    }
  }
  bool is_bounded(std::size_t body, int m, double size, double alpha = 1.0) {
    step.poses[2][body][m] = size;
    const bool answer = bounded(step, alpha);
    step.poses[2][body][m] = 0.0;
    return answer;
  }
};

using Trial = TrialOf<TouchingScene>;

TEST(Trial, MovesEverythingByAlphaTimesTheStep) {
  Trial trial;
  Rng rng(1);
  for (std::size_t k = 0; k < trial.step.poses.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      trial.step.poses[k][i] = testing::noise(3, 0.1, rng);
      trial.step.multipliers[k][i] = testing::noise(3, 1.0, rng);
    }
    trial.step.controls[k] = testing::noise(3, 1.0, rng);
    for (double& force : trial.force_step[k]) force = rng.uniform(0.1, 1.0);
  }
  make_trial(trial.scene.energy.scene(), trial.x, {trial.step, trial.force_step, 0.25},
             trial.moved);
  for (std::size_t k = 0; k < trial.step.poses.size(); ++k) {
    for (std::size_t m = 0; m < 9; ++m) {
      const auto row = static_cast<Eigen::Index>(m % 3);
      EXPECT_EQ(trial.moved.p[k].p[m], trial.x.p[k].p[m] + 0.25 * trial.step.poses[k][m / 3][row]);
      if (k > 0) {
        EXPECT_EQ(trial.moved.multipliers[k][m], 0.25 * trial.step.multipliers[k][m / 3][row]);
      }
    }
    for (std::size_t c = 0; c < trial.x.forces[k].size(); ++c)
      EXPECT_DOUBLE_EQ(trial.moved.forces[k][c],
                       trial.x.forces[k][c] + 0.25 * trial.force_step[k][c]);
    if (k > 0) {
      EXPECT_EQ(trial.moved.controls[k], Vector3d(0.25 * trial.step.controls[k]));
    }
    EXPECT_EQ(trial.moved.p[k].turns[1].s, std::sin(trial.moved.p[k].p[5]));
  }
}

TEST(Trial, JointedBodiesAndTheirMultipliersFollow) {
  TrialOf<testing::ChainScene> trial;
  Rng rng(1);
  for (std::size_t k = 0; k < trial.step.poses.size(); ++k)
    for (std::size_t i = 0; i < trial.step.poses[k].size(); ++i) {
      trial.step.poses[k][i] = testing::noise(3, 0.1, rng);
      trial.step.multipliers[k][i] = testing::noise(3, 1.0, rng);
    }
  const energy::SceneModel<double>& scene = trial.scene.energy.scene();
  make_trial(scene, trial.x, {trial.step, trial.force_step, 1.0}, trial.moved);
  for (std::size_t k = 0; k < trial.step.poses.size(); ++k) {
    energy::Placement<double> closed = trial.moved.p[k];
    scene.place(closed);
    EXPECT_EQ(closed.p, trial.moved.p[k].p);
    std::vector<double> y = trial.moved.multipliers[k];
    scene.articulation().apply_jacobian(closed, y.data());
    EXPECT_EQ(y, trial.moved.multipliers[k]);
    EXPECT_EQ(y[3] != 0.0, k > 0);  // of the first link, a child
  }
}

TEST(Trial, LongMovesTurnsAndNonsenseAreRefused) {
  Trial trial;
  EXPECT_TRUE(trial.is_bounded(0, 0, 0.99));
  EXPECT_FALSE(trial.is_bounded(0, 0, 1.01));
  EXPECT_TRUE(trial.is_bounded(0, 0, 1.99, 0.5));
  EXPECT_FALSE(trial.is_bounded(0, 0, 2.01, 0.5));
  EXPECT_TRUE(trial.is_bounded(0, 2, 0.49));
  EXPECT_FALSE(trial.is_bounded(0, 2, -0.51));
  EXPECT_TRUE(trial.is_bounded(0, 2, 0.99, 0.5));
  EXPECT_FALSE(trial.is_bounded(0, 2, 1.01, 0.5));
  EXPECT_FALSE(trial.is_bounded(1, 1, NAN));
  EXPECT_FALSE(trial.is_bounded(2, 2, INFINITY));
}

TEST(Trial, AForceThatIsAllButGoneIsGone) {
  Trial trial;
  const auto most = std::ranges::max_element(trial.x.forces[1]);
  const auto contact = static_cast<std::size_t>(most - trial.x.forces[1].begin());
  ASSERT_GT(*most, 0.0);
  for (const auto& [rest, gone] : {std::pair{1e-15, true}, std::pair{1e-9, false}}) {
    trial.force_step[1][contact] = -*most * (1.0 - rest);
    make_trial(trial.scene.energy.scene(), trial.x, {trial.step, trial.force_step, 1.0},
               trial.moved);
    EXPECT_EQ(trial.moved.forces[1][contact] == 0.0, gone) << rest;
  }
}

}  // namespace
}  // namespace rtg::reverse
