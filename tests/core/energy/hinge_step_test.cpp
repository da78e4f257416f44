#include "core/energy/hinge_step.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/chain_scene.hpp"
#include "tests/support/differences.hpp"

namespace rtg::energy {
namespace {

using testing::ChainScene;
using testing::closed;
using testing::of_coordinates;

/// Gradient and Hessian of Ψ over the coordinates, hinge by hinge.
StepEnergy::Model reduced(const StepEnergy& energy, const VectorXd& p, StepEnergy::Model model) {
  BlockMatrix<double> H(energy.dofs() / 3);
  for (int i = 0; i < H.M; ++i)
    for (int j = 0; j <= i; ++j)
      H.add(i, j, Block<double>(model.hessian.block<3, 3>(3 * i, 3 * j)));
  mirror_lower(H);
  const Articulation<double>& articulation = energy.scene().articulation();
  const Placement<double> at = placed(p);
  for (auto hinge = articulation.hinges().rbegin(); hinge != articulation.hinges().rend();
       ++hinge) {
    const HingeStep<double> step(articulation, *hinge, at);
    step.gather_both(H);
    step.add_curvature(model.gradient.data(), 1.0, H);
    step.gather(model.gradient.data());
  }
  for (int i = 0; i < H.M; ++i)
    for (int j = 0; j < H.M; ++j) model.hessian.block<3, 3>(3 * i, 3 * j) = H.at(i, j);
  return model;
}

// Ψ of a sub-step in contact as a function of the coordinates.
TEST(HingeStep, GradientAndHessianOfTheStepEnergyMatchDifferences) {
  const ChainScene scene;
  const StepEnergy& energy = scene.energy;
  const VectorXd now = stacked(scene.poses), previous_forces = energy.forces(now);
  ASSERT_GT(previous_forces.head(previous_forces.size() - 6).maxCoeff(), 0.0);
  ASSERT_GT(previous_forces.tail(6).maxCoeff(), 0.0);
  Rng rng(1);
  const auto at = [&](const VectorXd& d) {
    VectorXd p = now;
    p.head(d.size()) += of_coordinates(energy, d);
    return closed(energy, p);
  };
  const VectorXd d = testing::noise(energy.dofs(), 3e-3, rng);
  const auto value = [&](const VectorXd& x) {
    return VectorXd::Constant(1, energy.value(at(x), {now, previous_forces}));
  };
  const auto gradient = [&](const VectorXd& x) {
    return reduced(energy, at(x), energy.model(at(x), {now, previous_forces})).gradient;
  };
  const StepEnergy::Model model =
      reduced(energy, at(d), energy.model(at(d), {now, previous_forces}));
  EXPECT_EQ(model.gradient, of_coordinates(energy, model.gradient));
  std::vector<VectorXd> directions = testing::test_directions(model.gradient, rng);
  for (VectorXd& along : directions) along = of_coordinates(energy, along);
  EXPECT_LT(testing::derivative_error(value, model.gradient.transpose(), d, directions), 1e-7);
  EXPECT_LT(testing::derivative_error(gradient, model.hessian, d, directions), 1e-5);
  EXPECT_LT((model.hessian - model.hessian.transpose()).norm(), 1e-12);
}

TEST(HingeStep, CurvatureIsProportionalToItsWeight) {
  const ChainScene scene;
  const Articulation<double>& articulation = scene.energy.scene().articulation();
  const Placement<double> at = placed(stacked(scene.poses));
  const std::vector<double> g(at.p.size(), 1.0);
  const int M = scene.energy.dofs() / 3;
  for (const Hinge<double>& hinge : articulation.hinges()) {
    BlockMatrix<double> once(M), thrice(M);
    for (int i = 0; i < M; ++i) {
      once.add(i, i, Block<double>::Zero());
      thrice.add(i, i, Block<double>::Zero());
    }
    HingeStep<double>(articulation, hinge, at).add_curvature(g.data(), 1.0, once);
    HingeStep<double>(articulation, hinge, at).add_curvature(g.data(), 3.0, thrice);
    for (int i = 0; i < M; ++i) {
      const Block<double> excess = thrice.at(i, i) - 3.0 * once.at(i, i);
      EXPECT_LT(excess.norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace rtg::energy
