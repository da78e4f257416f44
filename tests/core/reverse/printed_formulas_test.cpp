// The formulas of the paper's appendix as printed, written down once more: integrals by quadrature,
// derivatives by differences in long double. They share no code with the library. Where the library
// departs from the printed text in the preset `paper` as well, the comment says so.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/math/kkt_solver.hpp"
#include "core/reverse/problem/reverse_model.hpp"
#include "tests/support/linearisation.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::reverse {
namespace {

using Real = long double;
using Numbers = std::vector<Real>;
struct Point {
  Real x, y;
};

constexpr double kAgreement = 1e-10;

/// The derivative of f at 0 by central differences, extrapolated twice.
Real derivative(const std::function<Real(Real)>& f) {
  const auto difference = [&](Real h) { return (f(h) - f(-h)) / (2 * h); };
  constexpr Real h = 2e-4L;
  const Real a = difference(h), b = difference(h / 2), c = difference(h / 4);
  const Real ab = (4 * b - a) / 3, bc = (4 * c - b) / 3;
  return (16 * bc - ab) / 15;
}

/// The gradient of f at x.
Numbers gradient(const std::function<Real(const Numbers&)>& f, const Numbers& x) {
  Numbers out(x.size());
  for (std::size_t k = 0; k < x.size(); ++k)
    out[k] = derivative([&](Real t) {
      Numbers moved = x;
      moved[k] += t;
      return f(moved);
    });
  return out;
}

/// App. A for the touching scene, in the units of NOTATION.md: times Δt²/k_D.
struct Printed {
  Scene scene;
  PhysicsConfig physics;
  ReverseConfig config;
  Vector3d bound;  // B_f, B_f, B_ω

  std::size_t bodies() const { return scene.size(); }
  Real unit() const {
    const Real dt = physics.time_step;
    return dt * dt / physics.damping;
  }
  const std::vector<Vector2d>& vertices(std::size_t i) const {
    return scene.bodies[i].shape.parts()[0].core.vertices;
  }

  /// X(x, p) of body i.
  static Point world(const Point& x, const Numbers& p, std::size_t i) {
    const Real c = std::cos(p[3 * i + 2]), s = std::sin(p[3 * i + 2]);
    return {c * x.x - s * x.y + p[3 * i], s * x.x + c * x.y + p[3 * i + 1]};
  }
  /// X⁻¹(x, p) of body j.
  static Point local(const Point& x, const Numbers& p, std::size_t j) {
    const Real c = std::cos(p[3 * j + 2]), s = std::sin(p[3 * j + 2]);
    const Real dx = x.x - p[3 * j], dy = x.y - p[3 * j + 1];
    return {c * dx + s * dy, -s * dx + c * dy};
  }
  Point vertex(std::size_t i, std::size_t k) const {
    return {Real(vertices(i)[k].x()), Real(vertices(i)[k].y())};
  }

  /// ∫ f over body i, for f of degree 2: the midpoints of the sides of triangles.
  Real integral(std::size_t i, const std::function<Real(const Point&)>& f) const {
    Real sum = 0;
    for (std::size_t k = 1; k + 1 < vertices(i).size(); ++k) {
      const Point a = vertex(i, 0), b = vertex(i, k), c = vertex(i, k + 1);
      const Real area = ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
      const auto middle = [](const Point& u, const Point& v) {
        return Point{(u.x + v.x) / 2, (u.y + v.y) / 2};
      };
      sum += area / 3 * (f(middle(a, b)) + f(middle(b, c)) + f(middle(c, a)));
    }
    return sum;
  }
  /// ∫ ρ/2 |Σ_m w_m X(x, p_m)|² over all bodies: I with w = (1, -2, 1), I_D with w = (1, -1).
  Real motion(const std::vector<std::pair<Real, const Numbers*>>& terms) const {
    Real sum = 0;
    for (std::size_t i = 0; i < bodies(); ++i)
      sum += Real(scene.bodies[i].density) / 2 * integral(i, [&](const Point& x) {
               Point total{0, 0};
               for (const auto& [weight, p] : terms) {
                 const Point at = world(x, *p, i);
                 total = {total.x + weight * at.x, total.y + weight * at.y};
               }
               return total.x * total.x + total.y * total.y;
             });
    return sum;
  }

  /// d_j of a point in the frame of body j, with its gradient; the smoothing is ours, α.
  struct Distance {
    Real value;
    Point gradient;
  };
  Distance distance(std::size_t j, const Point& x) const {
    const Real alpha = physics.sharpness;
    Real sum = 0;
    Point pull{0, 0};
    const std::size_t n = vertices(j).size();
    for (std::size_t k = 0; k < n; ++k) {
      const Point a = vertex(j, k), b = vertex(j, (k + 1) % n);
      const Real length = std::hypot(b.x - a.x, b.y - a.y);
      const Point normal{(b.y - a.y) / length, -(b.x - a.x) / length};
      const Real part = std::exp(alpha * (normal.x * (x.x - a.x) + normal.y * (x.y - a.y)));
      sum += part;
      pull = {pull.x + part * normal.x, pull.y + part * normal.y};
    }
    return {std::log(sum) / alpha, {pull.x / sum, pull.y / sum}};
  }
  Real mu() const { return Real(physics.barrier) * unit(); }

  void each_contact(const std::function<void(std::size_t, std::size_t, std::size_t)>& f) const {
    for (std::size_t j = 0; j < bodies(); ++j)
      for (std::size_t i = 0; i < bodies(); ++i)
        for (std::size_t k = 0; i != j && k < vertices(i).size(); ++k) f(j, i, k);
  }

  /// P_⊥.
  Real normal(const Numbers& p) const {
    Real sum = 0;
    each_contact([&](std::size_t j, std::size_t i, std::size_t k) {
      sum -= mu() * std::log(distance(j, local(world(vertex(i, k), p, i), p, j)).value);
    });
    return sum;
  }
  /// P_∥, with μ once, without 1/Δt, and with the tangential displacement u smoothed: departures
  /// that SlipTerms names. The force is printed as ϖ|∂log d|; |∂d| stands with u there.
  Real friction(const Numbers& next, const Numbers& now) const {
    Real sum = 0;
    each_contact([&](std::size_t j, std::size_t i, std::size_t k) {
      const Point v = vertex(i, k), x = local(world(v, now, i), now, j);
      const Point a = world(v, next, i), b = world(x, next, j);  // both were at the same place
      const auto [d, n] = distance(j, x);
      const Real c = std::cos(next[3 * j + 2]), s = std::sin(next[3 * j + 2]);
      const Point tangent{-s * n.x - c * n.y, c * n.x - s * n.y};
      const Real u = tangent.x * (a.x - b.x) + tangent.y * (a.y - b.y), eps = physics.slip;
      const Real coefficient =
          std::sqrt(Real(scene.bodies[i].friction) * Real(scene.bodies[j].friction));
      sum += coefficient * mu() / d * (std::sqrt(u * u + eps * eps) - eps);
    });
    return sum;
  }
  /// P_E.
  Real external(const Numbers& next, const Numbers& c) const {
    Real sum = 0;
    for (std::size_t m = 0; m < 3; ++m)
      sum -= Real(bound[static_cast<Eigen::Index>(m)]) * std::tanh(c[m]) * next[m];
    return sum;
  }
  /// Ψ(p_{t+1}, p_t, p_{t-1}, c_t).
  Real energy(const Numbers& next, const Numbers& now, const Numbers& before,
              const Numbers& c) const {
    Real sum =
        motion({{1, &next}, {-1, &now}}) + normal(next) + friction(next, now) + external(next, c);
    if (physics.inertia)
      sum += motion({{1, &next}, {-2, &now}, {1, &before}}) / Real(physics.damping);
    return sum;
  }
  /// An entry of Φ = ∂Ψ/∂p_{t+1}, eq. (7).
  Real residual(std::size_t entry, const Numbers& next, const Numbers& now, const Numbers& before,
                const Numbers& c) const {
    return derivative([&](Real t) {
      Numbers moved = next;
      moved[entry] += t;
      return energy(moved, now, before, c);
    });
  }
};

Numbers numbers(const VectorXd& x) { return {x.begin(), x.end()}; }

/// A trajectory of the touching scene in the preset `paper`, disturbed, with the forces of its gaps
/// and no multipliers.
struct Case {
  testing::TouchingScene touching;
  ReverseConfig config = reverse_preset(ReversePreset::kPaper);
  ReverseModel model;
  energy::StepEnergy energy;
  ReverseProblem problem;
  Iterate x;
  Printed printed;

  explicit Case(bool inertia, int sub_steps = 2)
      : model(model_of(touching, config, inertia, sub_steps)),
        energy(model.scene, model.physics, touching.task.push),
        problem{energy, config, energy::stacked(touching.poses), Vector2d(0.6, 0.8),
                model.physics.sub_steps},
        x(static_iterate(problem)),
        printed{model.scene, model.physics, config, energy.control_bound()} {
    Rng rng(3);
    for (std::size_t k = 0; k < x.p.size(); ++k) {
      if (k + 1 < x.p.size()) x.p[k] += testing::noise(x.p[k].size(), 0.01, rng);
      x.forces[k] = energy.forces(x.p[k]);
      x.controls[k] = testing::noise(3, 0.5, rng);
    }
  }

  static ReverseModel model_of(const testing::TouchingScene& touching, const ReverseConfig& config,
                               bool inertia, int sub_steps) {
    PhysicsConfig physics;
    physics.sub_steps = sub_steps;
    physics.inertia = inertia;
    physics.damping = inertia ? 1.0 : physics.damping;
    return reverse_model(touching.scene, physics, config);
  }

  std::size_t h() const { return static_cast<std::size_t>(problem.sub_steps); }
  Numbers pose(std::size_t k) const { return numbers(x.p[k]); }
  Numbers control(std::size_t k) const { return numbers(x.controls[k]); }
  /// An entry of Φ_k with the poses p; everything rests before the first sub-step.
  Real residual(std::size_t entry, const std::vector<Numbers>& p, std::size_t k,
                const Numbers& c) const {
    return printed.residual(entry, p[k], p[k - 1], p[k > 1 ? k - 2 : 0], c);
  }
  std::vector<Numbers> poses() const {
    std::vector<Numbers> out;
    for (const VectorXd& p : x.p) out.push_back(numbers(p));
    return out;
  }
  /// Eq. (6), up to the constant by which distances count from the final state.
  Real objective(const Numbers& start) const {
    Real sum = printed.normal(start);
    for (std::size_t i = 0; i < printed.bodies(); ++i)
      for (std::size_t m = 0; m < 2; ++m)
        sum += (start[3 * i + m] - Real(problem.end[static_cast<Eigen::Index>(3 * i + m)])) *
               Real(problem.direction[static_cast<Eigen::Index>(m)]);
    for (std::size_t k = 1; k <= h(); ++k)
      sum += Real(config.control_weight) * Real(x.controls[k].squaredNorm());
    return sum;
  }
};

class PrintedFormulas : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Modes, PrintedFormulas, ::testing::Bool(),
                         [](const auto& mode) { return mode.param ? "dynamic" : "quasi_static"; });

TEST_P(PrintedFormulas, TheStepEnergyIsPsi) {
  const Case at(GetParam());
  const Numbers none(3, 0);
  for (std::size_t k = 1; k <= at.h(); ++k) {
    const VectorXd& before = at.x.p[k > 1 ? k - 2 : 0];
    const double ours = at.energy.value(at.x.p[k], {at.x.p[k - 1], at.x.forces[k - 1], &before});
    const Real theirs = at.printed.energy(at.pose(k), at.pose(k - 1), numbers(before), none);
    EXPECT_NEAR(ours, static_cast<double>(theirs), kAgreement) << k;
  }
}

TEST_P(PrintedFormulas, TheConstraintsAreItsGradients) {
  const Case at(GetParam());
  const Violation found = violation(at.problem, at.x);
  for (std::size_t k = 1; k <= at.h(); ++k)
    for (std::size_t a = 0; a < at.pose(0).size(); ++a)
      EXPECT_NEAR(found.residuals[k][static_cast<Eigen::Index>(a)],
                  static_cast<double>(at.residual(a, at.poses(), k, at.control(k))), kAgreement)
          << k << ", " << a;
}

TEST_P(PrintedFormulas, TheObjectiveIsThatOfEquation6) {
  const Case at(GetParam());
  EXPECT_NEAR(objective(at.problem, at.x), static_cast<double>(at.objective(at.pose(0))),
              kAgreement);
}

/// The matrix and the right-hand side of eq. (10), in the order (p_0, c_1, λ_1, p_1, c_2, λ_2,
/// ...).
struct PrintedKkt {
  MatrixXd K;
  VectorXd r;

  explicit PrintedKkt(const Case& at) {
    const std::size_t n = at.pose(0).size(), stride = 2 * n + 3;
    K = MatrixXd::Zero(static_cast<Eigen::Index>(at.h() * stride),
                       static_cast<Eigen::Index>(at.h() * stride));
    r = VectorXd::Zero(K.rows());
    add_objective(at, stride);
    for (std::size_t k = 1; k <= at.h(); ++k) add_constraint(at, k, n, stride);
  }

 private:
  void set(std::size_t row, std::size_t column, Real value) {
    K(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
        K(static_cast<Eigen::Index>(column), static_cast<Eigen::Index>(row)) =
            static_cast<double>(value);
  }

  void add_objective(const Case& at, std::size_t stride) {
    const auto J = [&](const Numbers& start) { return at.objective(start); };
    const Numbers start = at.pose(0), slope = gradient(J, start);
    const std::size_t n = start.size();
    for (std::size_t a = 0; a < n; ++a) {
      r[static_cast<Eigen::Index>(a)] = static_cast<double>(-slope[a]);
      const Numbers row = gradient(
          [&](const Numbers& p) {
            return derivative([&](Real t) {
              Numbers moved = p;
              moved[a] += t;
              return J(moved);
            });
          },
          start);
      for (std::size_t b = 0; b < n; ++b) set(a, b, row[b]);
    }
    const Real price = at.config.control_weight;
    for (std::size_t k = 1; k <= at.h(); ++k)
      for (std::size_t m = 0; m < 3; ++m) {
        const std::size_t own = (k - 1) * stride + n + m;
        set(own, own, 2 * price);
        r[static_cast<Eigen::Index>(own)] = static_cast<double>(-2 * price * at.control(k)[m]);
      }
  }

  void add_constraint(const Case& at, std::size_t k, std::size_t n, std::size_t stride) {
    const std::size_t row = (k - 1) * stride + n + 3;
    for (std::size_t a = 0; a < n; ++a) {
      const Real value = at.residual(a, at.poses(), k, at.control(k));
      r[static_cast<Eigen::Index>(row + a)] = static_cast<double>(-value);
      for (std::size_t level = 0; level < at.h(); ++level)
        for (std::size_t b = 0; b < n && level + 2 >= k && level <= k; ++b)
          set(row + a, level * stride + b, derivative([&](Real t) {
                std::vector<Numbers> p = at.poses();
                p[level][b] += t;
                return at.residual(a, p, k, at.control(k));
              }));
      for (std::size_t m = 0; m < 3; ++m)
        set(row + a, (k - 1) * stride + n + m, derivative([&](Real t) {
              Numbers c = at.control(k);
              c[m] += t;
              return at.residual(a, at.poses(), k, c);
            }));
    }
  }
};

// K is shifted by 1e-9 in the rows of the multipliers.
TEST_P(PrintedFormulas, TheKktSystemIsThatOfEquation10) {
  const Case at(GetParam());
  const PrintedKkt printed(at);
  const testing::Linearisation lin(at.problem, at.x, {false, 0.0, true});
  const MatrixXd ours = lin.matrix().dense();
  ASSERT_EQ(ours.rows(), printed.K.rows());
  const MatrixXd shift = (ours - printed.K).diagonal().asDiagonal();
  EXPECT_LT((ours - printed.K - shift).lpNorm<Eigen::Infinity>(),
            kAgreement * printed.K.lpNorm<Eigen::Infinity>());
  EXPECT_LT(shift.lpNorm<Eigen::Infinity>(), 2e-9);
  const VectorXd r = joined(lin.right_hand_side());
  EXPECT_LT((r - printed.r).lpNorm<Eigen::Infinity>(), kAgreement * printed.r.norm());
}

// Five blocks take three reductions; blocks with a neighbour on either side are eliminated in two
// of them.
TEST_P(PrintedFormulas, CyclicReductionSolvesTheKktSystem) {
  const Case at(GetParam(), 5);
  const testing::Linearisation regular(at.problem, at.x, {false, 1e-6, true});
  const BlockTridiagonal K = regular.matrix();
  ASSERT_EQ(K.blocks(), 5U);
  const auto cyclic_reduction = make_kkt_solver(KktMethod::kCyclicReduction);
  ASSERT_TRUE(cyclic_reduction->factorize(K));
  const VectorXd r = joined(regular.right_hand_side());
  const VectorXd x = joined(cyclic_reduction->solve(regular.right_hand_side()));
  EXPECT_LT((K.dense() * x - r).norm(), kAgreement * (K.dense().norm() * x.norm() + r.norm()));
}

}  // namespace
}  // namespace rtg::reverse
