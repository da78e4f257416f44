// A row of six bodies in contact, over the number of sub-steps h: factorisation and solution of the
// KKT system; a whole SQP iteration with one trial point.

#include <benchmark/benchmark.h>

#include <string>

#include "core/reverse/linearisation.hpp"
#include "core/reverse/trial.hpp"
#include "tests/support/gathering.hpp"

namespace rtg {
namespace {

using testing::gathering;

constexpr int kBodies = 6;
constexpr double kResidual = 1e-9;  // of the right-hand side, largest accepted

/// The robot and five boxes in a row, nearly touching.
class Row {
 public:
  explicit Row(int sub_steps) : problem_{energy_, config_, poses(), Vector2d::UnitX(), sub_steps} {}

  const ReverseProblem& problem() const { return problem_; }
  Linearisation linearisation() const { return {problem_, static_iterate(problem_), {true, 1.0}}; }

 private:
  static Scene scene() {
    const Task task = gathering();
    Scene row{{task.scene.bodies[0]}};
    row.bodies.resize(kBodies, task.scene.bodies[1]);
    return row;
  }
  static VectorXd poses() {
    VectorXd p = VectorXd::Zero(3 * kBodies);
    for (int k = 1; k < kBodies; ++k) p[3 * k] = 1.46 + 1.28 * (k - 1);
    return p;
  }

  ReverseConfig config_;
  StepEnergy energy_{scene(), {}, gathering().push};
  ReverseProblem problem_;
};

double norm(const BlockVector& x) { return joined(x).lpNorm<Eigen::Infinity>(); }

void check_residual(benchmark::State& state, const Linearisation& lin, const BlockVector& x,
                    const BlockVector& r) {
  const double residual = (joined(product(lin.matrix(), x)) - joined(r)).lpNorm<Eigen::Infinity>();
  if (!(residual <= kResidual * norm(r))) state.SkipWithError("the residual is too large");
}

void kkt(benchmark::State& state, KktMethod method) {
  const Row row(static_cast<int>(state.range(0)));
  const Linearisation lin = row.linearisation();
  const BlockVector r = lin.right_hand_side(lin.violation());
  const std::unique_ptr<KktSolver> solver = make_kkt_solver(method);
  BlockVector x;
  for (auto _ : state) {
    if (!solver->factorize(lin.matrix())) return state.SkipWithError("singular");
    x = solver->solve(r);
    benchmark::DoNotOptimize(x.data());
  }
  check_residual(state, lin, x, r);
}

void sqp_iteration(benchmark::State& state) {
  const Row row(static_cast<int>(state.range(0)));
  const Iterate x = static_iterate(row.problem());
  const std::unique_ptr<KktSolver> solver = make_kkt_solver({});
  BlockVector r, step;
  for (auto _ : state) {
    const Linearisation lin = row.linearisation();
    if (!solver->factorize(lin.matrix())) return state.SkipWithError("singular");
    step = solver->solve(r = lin.right_hand_side(lin.violation()));
    if (!(lin.model_curvature(step) > 0.0)) return state.SkipWithError("no descent");
    const auto trial = trial_point(row.problem(), x, lin.direction(step, lin.violation()), 1e-3);
    if (!trial) return state.SkipWithError("the step is too long");
    benchmark::DoNotOptimize(violation(row.problem(), *trial).l1());
    benchmark::DoNotOptimize(objective(row.problem(), x) + objective(row.problem(), *trial));
  }
  check_residual(state, row.linearisation(), step, r);
}
BENCHMARK(sqp_iteration)->RangeMultiplier(2)->Range(8, 256)->Unit(benchmark::kMicrosecond);

const bool kRegistered = [] {
  for (std::size_t m = 0; m < kKktMethods.size(); ++m)
    benchmark::RegisterBenchmark(("kkt/" + std::string(kKktMethods[m])).c_str(), kkt,
                                 static_cast<KktMethod>(m))
        ->RangeMultiplier(4)
        ->Range(16, 256)
        ->Unit(benchmark::kMicrosecond);
  return true;
}();

}  // namespace
}  // namespace rtg
