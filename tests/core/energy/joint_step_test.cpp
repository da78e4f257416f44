#include "core/energy/joint_step.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/chain_scene.hpp"
#include "tests/support/differences.hpp"

namespace rtg::energy {
namespace {

using testing::advanced;
using testing::ChainScene;
using testing::of_coordinates;
using testing::SliderScene;

template <class Scene>
class JointStepTest : public ::testing::Test {};
using Scenes = ::testing::Types<ChainScene, SliderScene>;
TYPED_TEST_SUITE(JointStepTest, Scenes);

// Ψ of a sub-step in contact as a function of the coordinates.
TYPED_TEST(JointStepTest, GradientAndHessianOfTheStepEnergyMatchDifferences) {
  const TypeParam scene;
  const StepEnergy& energy = scene.energy;
  const VectorXd now = stacked(scene.poses), previous_forces = energy.forces(now);
  const auto limits = 2 * static_cast<Eigen::Index>(scene.scene.joints.size());
  ASSERT_GT(previous_forces.head(previous_forces.size() - limits).maxCoeff(), 0.0);
  ASSERT_GT(previous_forces.tail(limits).maxCoeff(), 0.0);
  Rng rng(1);
  const auto at = [&](const VectorXd& d) {
    return advanced(energy, now, of_coordinates(energy, d));
  };
  const VectorXd d = testing::noise(energy.dofs(), 3e-3, rng);
  const auto value = [&](const VectorXd& x) {
    return VectorXd::Constant(1, energy.value(at(x), {now, previous_forces}));
  };
  const auto gradient = [&](const VectorXd& x) {
    return energy.model(at(x), {now, previous_forces}).gradient;
  };
  const StepEnergy::Model model = energy.model(at(d), {now, previous_forces});
  EXPECT_EQ(model.gradient, of_coordinates(energy, model.gradient));
  std::vector<VectorXd> directions = testing::test_directions(model.gradient, rng);
  for (VectorXd& along : directions) along = of_coordinates(energy, along);
  EXPECT_LT(testing::derivative_error(value, model.gradient.transpose(), d, directions), 1e-7);
  EXPECT_LT(testing::derivative_error(gradient, model.hessian, d, directions), 1e-5);
  EXPECT_LT((model.hessian - model.hessian.transpose()).norm(), 1e-12);
}

TYPED_TEST(JointStepTest, CurvatureIsProportionalToItsWeight) {
  const TypeParam scene;
  const Articulation<double>& articulation = scene.energy.scene().articulation();
  const Placement<double> at = placed(stacked(scene.poses));
  const std::vector<double> g(at.p.size(), 1.0);
  const int M = scene.energy.dofs() / 3;
  for (const JointModel<double>& joint : articulation.joints()) {
    BlockMatrix<double> once(M), thrice(M);
    for (int i = 0; i < M; ++i) {
      once.add(i, i, Block<double>::Zero());
      thrice.add(i, i, Block<double>::Zero());
    }
    JointStep<double>(articulation, joint, at).add_curvature(g.data(), 1.0, once);
    JointStep<double>(articulation, joint, at).add_curvature(g.data(), 3.0, thrice);
    for (int i = 0; i < M; ++i)
      for (int j = 0; j < M; ++j) {
        ASSERT_EQ(once.has(i, j), thrice.has(i, j));
        if (!once.has(i, j)) continue;
        const Block<double> excess = thrice.at(i, j) - 3.0 * once.at(i, j);
        EXPECT_LT(excess.norm(), 1e-12);
      }
  }
}

TYPED_TEST(JointStepTest, RatesAreThoseOfTheValues) {
  const TypeParam scene;
  const StepEnergy& energy = scene.energy;
  const Articulation<double>& articulation = energy.scene().articulation();
  const VectorXd p = stacked(scene.poses);
  Rng rng(7);
  const VectorXd y = of_coordinates(energy, testing::noise(energy.dofs(), 1.0, rng));
  const VectorXd w = testing::apply_jacobian(energy, p, y);
  const double t = 1e-6;
  const Placement<double> at = placed(p), up = placed(advanced(energy, p, t * y)),
                          down = placed(advanced(energy, p, -t * y));
  for (const JointModel<double>& joint : articulation.joints())
    EXPECT_NEAR(JointStep<double>(articulation, joint, at).value_rate(w.data()),
                (value_of(joint, up) - value_of(joint, down)) / (2.0 * t), 1e-8);
}

}  // namespace
}  // namespace rtg::energy
