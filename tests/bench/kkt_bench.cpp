// Six bodies over the number of sub-steps h: solution of the KKT system, in lanes and by its peers;
// a whole SQP iteration with one trial point, over h and over the number of bodies. Times of lanes
// are those of all of them, as many as the counter `candidates` says. All run on one core; the
// peers solve one problem at a time, as they have no lanes. `own_us` is the part of a peer's time
// that is spent in its library.

#include <benchmark/benchmark.h>

#include <array>
#include <string>
#include <string_view>

#include "core/math/assembled_solver.hpp"
#include "core/math/riccati.hpp"
#include "core/reverse/problem/evaluator.hpp"
#include "core/reverse/problem/newton_system.hpp"
#include "core/reverse/problem/trial_point.hpp"
#include "tests/bench/kkt_peers.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/random_stages.hpp"
#include "tests/support/stage_lanes.hpp"

namespace rtg::bench {
namespace {

using testing::gathering;
using testing::row_of_boxes;
using testing::row_poses;

constexpr double kResidual = 2e-9;  // largest accepted; the assembled matrix is shifted by 1e-9

/// The robot and boxes in a row, nearly touching, in every lane.
template <class T>
class Row {
 public:
  explicit Row(int sub_steps, const PhysicsConfig& physics = {}, int bodies = kBodies)
      : energy_(row_of_boxes(bodies), physics, gathering().push),
        problem_{energy_, config_, row_poses(bodies), Vector2d::UnitX(), sub_steps},
        lanes_(problem_),
        x_(lanes_.energy, sub_steps),
        newton_(lanes_) {
    for (int l = 0; l < kWidth<T>; ++l) {
      lanes_.load(l, problem_);
      x_.load(l, problem_, static_iterate(problem_));
    }
    linearise();
  }
  void linearise() { newton_.linearise(lanes_, x_, {T(1.0), T(1.0), T(1.0)}); }

  const reverse::ProblemLanes<T>& problem() const { return lanes_; }
  const reverse::Trajectory<T>& x() const { return x_; }
  const reverse::NewtonSystem<T>& newton() const { return newton_; }

 private:
  reverse::ReverseConfig config_;
  energy::StepEnergy energy_;
  reverse::ReverseProblem problem_;
  reverse::ProblemLanes<T> lanes_;
  reverse::Trajectory<T> x_;
  reverse::NewtonSystem<T> newton_;
};

/// Newton systems of six bodies: of a row in contact, quasi-static or with inertia, and random ones
/// in which every body is coupled with every other.
enum class Family { kRow, kInertia, kRandom };
constexpr std::array<std::string_view, 3> kFamilies{"kkt", "kkt_inertia", "kkt_random"};

template <class T>
StageSystem<T> instance(Family family, int h) {
  StageSystem<T> random(kBodies, h);
  if (family == Family::kRandom) {
    for (int l = 0; l < kWidth<T>; ++l)
      testing::randomise(random, l, kBodies, static_cast<std::uint64_t>(l));
    return random;
  }
  PhysicsConfig physics;
  physics.inertia = family == Family::kInertia;
  return Row<T>(h, physics).newton().system();
}

/// Puts the residual of a step, ‖K x - r‖∞ / (‖r‖∞ + ‖x‖∞), on the benchmark's row, and refuses a
/// large one.
void check(benchmark::State& state, const StageSystem<double>& system,
           const StageStep<double>& step) {
  const Assembled assembled(system, false);
  const VectorXd r = joined(assembled.right_hand_side());
  const BlockVector x = assembled.written(step);
  const double scale = r.lpNorm<Eigen::Infinity>() + joined(x).lpNorm<Eigen::Infinity>();
  const VectorXd off = joined(product(assembled.matrix(), x)) - r;
  const double residual = off.lpNorm<Eigen::Infinity>() / scale;
  state.counters["residual"] = residual;
  if (!(residual <= kResidual)) state.SkipWithError("the residual is too large");
}

void kkt_lanes(benchmark::State& state, Family family) {
  const int h = static_cast<int>(state.range(0));
  const StageSystem<Lanes> system = instance<Lanes>(family, h);
  Riccati<Lanes> solver(kBodies, h);
  StageStep<Lanes> step(kBodies, h);
  for (auto _ : state) {
    benchmark::DoNotOptimize(solver.solve(system, step));
    benchmark::ClobberMemory();
  }
  check(state, instance<double>(family, h), testing::lane_of(step, 0));
  state.counters["candidates"] = kWidth<Lanes>;
}

using MakePeer = std::unique_ptr<KktPeer> (*)(const StageSystem<double>& system);

void kkt_peer(benchmark::State& state, Family family, MakePeer make) {
  const StageSystem<double> system = instance<double>(family, static_cast<int>(state.range(0)));
  const std::unique_ptr<KktPeer> peer = make(system);
  for (auto _ : state) {
    if (!peer->solve()) return state.SkipWithError("singular");
    benchmark::ClobberMemory();
  }
  if (peer->own_cpu_s() > 0.0)
    state.counters["own_us"] = 1e6 * peer->own_cpu_s() / static_cast<double>(state.iterations());
  StageStep<double> step(kBodies, system.h);
  peer->read(step);
  check(state, system, step);
}

void sqp_iteration(benchmark::State& state, int bodies, int h) {
  Row<Lanes> row(h, {}, bodies);
  Riccati<Lanes> solver(bodies, h);
  StageStep<Lanes> step(bodies, h);
  reverse::Evaluator<Lanes> evaluator(row.problem());
  reverse::Trajectory<Lanes> trial = row.x();
  reverse::PerContact<Lanes> force_step = trial.forces, gaps = trial.forces,
                             trial_gaps = trial.forces;
  for (std::vector<Lanes>& level : gaps) level.assign(level.size(), Lanes(0.0));
  for (auto _ : state) {
    row.linearise();
    benchmark::DoNotOptimize(row.newton().stationarity());
    benchmark::DoNotOptimize(solver.solve(row.newton().system(), step));
    benchmark::DoNotOptimize(row.newton().model_curvature(step));
    row.newton().force_steps(row.problem(), row.x(), step, force_step);
    Mask<Lanes> legal = reverse::bounded(step, Lanes(1e-3));
    make_trial(row.problem().energy, row.x(), {step, force_step, Lanes(1e-3)}, trial);
    benchmark::DoNotOptimize(evaluator.evaluate(row.problem(), trial, gaps, trial_gaps, legal));
    if (!any(legal)) return state.SkipWithError("the trial point is not legal");
  }
  check(state, Row<double>(h, {}, bodies).newton().system(), testing::lane_of(step, 0));
  state.counters["candidates"] = kWidth<Lanes>;
}

void over_sub_steps(benchmark::State& state) {
  sqp_iteration(state, kBodies, static_cast<int>(state.range(0)));
}
void over_bodies(benchmark::State& state) {
  sqp_iteration(state, static_cast<int>(state.range(0)), 10);
}

/// Fused multiplications and additions in registers: what the processor can do at most.
void peak(benchmark::State& state) {
  constexpr int kChains = 16, kLength = 1000;
  Lanes sums[kChains];
  for (int k = 0; k < kChains; ++k) sums[k] = Lanes(1.0 + k);
  const Lanes factor(0.999999), summand(1e-6);
  for (auto _ : state) {
    for (int n = 0; n < kLength; ++n)
      for (Lanes& sum : sums) sum = sum * factor + summand;
    benchmark::DoNotOptimize(sums);
  }
  state.counters["GFLOP/s"] = benchmark::Counter(2e-9 * kChains * kLength * kWidth<Lanes>,
                                                 benchmark::Counter::kIsIterationInvariantRate);
}

const std::vector<std::pair<std::string, MakePeer>> kPeers{
    {"cyclic_reduction", cyclic_reduction_peer},
    {"klu", klu_peer},
#ifdef RTG_HPIPM
    {"hpipm", hpipm_peer},
#endif
};

void register_family(Family family) {
  const std::string name(kFamilies[static_cast<std::size_t>(family)]);
  std::vector<benchmark::internal::Benchmark*> all{
      benchmark::RegisterBenchmark((name + "/lanes").c_str(), kkt_lanes, family)};
  for (const auto& [peer, make] : kPeers)
    all.push_back(
        benchmark::RegisterBenchmark((name + '/' + peer).c_str(), kkt_peer, family, make));
  for (auto* one : all) one->RangeMultiplier(4)->Range(16, 256)->Unit(benchmark::kMicrosecond);
}

const bool kRegistered = [] {
  benchmark::AddCustomContext("compiler", __VERSION__);
  benchmark::AddCustomContext("lanes", std::to_string(kWidth<Lanes>));
  for (const Family family : {Family::kRow, Family::kInertia, Family::kRandom})
    register_family(family);
  benchmark::RegisterBenchmark("sqp_iteration", over_sub_steps)
      ->RangeMultiplier(2)
      ->Range(8, 256)
      ->Repetitions(3)
      ->ReportAggregatesOnly()
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("sqp_iteration_bodies", over_bodies)
      ->DenseRange(2, 16, 2)
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("peak/fma", peak)->Unit(benchmark::kMicrosecond);
  return true;
}();

}  // namespace
}  // namespace rtg::bench
