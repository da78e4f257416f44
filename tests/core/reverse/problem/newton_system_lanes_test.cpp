// The Newton systems of many candidates at once, and their steps.

#include <gtest/gtest.h>

#include "core/math/riccati.hpp"
#include "tests/support/linearisation.hpp"
#include "tests/support/one_candidate.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using testing::Direction;
using testing::disturbed;
using testing::Linearisation;
using testing::solution_of;
using testing::TouchingScene;

/// Lane l holds a candidate of its own: the touching scene, disturbed differently.
struct InLanes {
  TouchingScene scene;
  ReverseConfig config;
  ReverseProblem problem = scene.problem(config);
  ProblemLanes<Lanes> lanes{problem};
  Trajectory<Lanes> x{lanes.energy, problem.sub_steps};
  std::vector<Iterate> each;

  InLanes() {
    Rng rng(11);
    const Iterate start = testing::in_contact(problem);
    for (int l = 0; l < kWidth<Lanes>; ++l) {
      each.push_back(disturbed(start, 1e-3, rng));
      lanes.load(l, problem);
      x.load(l, problem, each.back());
    }
  }
};

// Each lane against the one lane of double: the Hessian is that of the Lagrangian in the odd ones,
// that of the objective in the even ones.
TEST(NewtonSystemLanes, LanesAgreeWithDouble) {
  const InLanes in;
  Lanes lagrangian(0.0);
  for (int l = 1; l < kWidth<Lanes>; l += 2) set_lane(lagrangian, l, 1.0);
  NewtonSystem<Lanes> newton(in.lanes);
  newton.linearise(in.lanes, in.x, {lagrangian, Lanes(0.3), lagrangian});
  StageStep<Lanes> step(3, 10);
  Riccati<Lanes> riccati(3, 10);
  const Mask<Lanes> regular = riccati.solve(newton.system(), step);
  PerContact<Lanes> forces = in.x.forces;
  newton.force_steps(in.lanes, in.x, step, forces);
  for (int l = 0; l < kWidth<Lanes>; ++l) {
    ASSERT_TRUE(lane(regular, l));
    const Linearisation one(in.problem, in.each[static_cast<std::size_t>(l)], {l % 2 == 1, 0.3});
    EXPECT_NEAR(lane(newton.stationarity(), l), one.newton().stationarity(), 1e-10);
    const Direction d = one.direction(solution_of(one), true);
    double error = 0.0;
    for (std::size_t k = 0; k < d.p.size(); ++k) {
      for (std::size_t m = 0; m < 9; ++m) {
        const auto row = static_cast<Eigen::Index>(m);
        error = std::max(error, std::abs(lane(step.poses[k][m / 3][row % 3], l) - d.p[k][row]));
      }
      std::vector<double> lambda;
      for (const Lanes& force : forces[k]) lambda.push_back(lane(force, l));
      error = std::max(error, (in.scene.energy.from_contact_index(lambda) - d.forces[k]).norm());
    }
    EXPECT_LT(error, 1e-6) << "lane " << l;
  }
}

}  // namespace
}  // namespace rtg::reverse
