#pragma once

#include <utility>

#include "core/reverse/problem/reverse_config.hpp"
#include "core/reverse/problem/solve_status.hpp"
#include "core/reverse/sqp/filter.hpp"

namespace rtg::reverse {

/// Controls the SQP of one candidate. It decides which Hessian and which δ the next step uses,
/// whether a trial point is accepted, and when the SQP ends. It knows only a few figures of each
/// iterate.
///
/// Departs from the paper: it has no restoration of feasibility. Here, where no δ helps, the SQP
/// asks for one and begins with an empty filter and the first δ again; with a fixed final state the
/// filter is only emptied. The SQP ends if no step is accepted after that. It leaves 0.05 %
/// of the problems of tests/bench/corpus undecided and 0.8 % of those of corpus_joints. If the
/// filter is only emptied everywhere, it is 0.5 % and 1.9 %. At the iteration limit feasibility is
/// restored once more. A start from which the simulation reaches the final state is a solution then
/// (SolveStatus::kAcceptable). With it 984 of 1,000 true pushes are found (true_pushes on
/// Gathering, Sorting, ArtManip, a chain of six and a door), without it 977.
class SqpStrategy {
 public:
  /// The figures of an iterate on which decisions depend.
  struct Figures {
    double objective = 0.0;
    double infeasibility = 0.0;  // ‖C‖∞
    double stationarity = 0.0;   // ‖∇L‖∞
  };

  explicit SqpStrategy(const ReverseConfig& config);

  double proximal() const { return proximal_; }  // δ
  /// Returns whether the next step uses the Hessian of the Lagrangian. Otherwise it uses that of
  /// the objective.
  bool uses_lagrangian() const { return uses_lagrangian_; }
  int iterations() const { return iterations_; }
  SolveStatus status() const { return status_; }

  /// Decides at an iterate with the figures `at` whether the SQP goes on, with a restoration if
  /// wants_restoration(), otherwise with another step. If not, it has ended with status(). To be
  /// called after each linearisation. Counts an iteration, unless it repeats one with the Hessian
  /// of the objective or goes on with a restoration.
  bool goes_on(const Figures& at);
  /// To be called if the usual solver met a singular pivot. Returns whether to solve the Newton
  /// system again, with pivoting: true ten times, and ten more after a restoration.
  bool may_pivot();
  /// Repeats the iteration with the Hessian of the objective or, if that was used already, with a
  /// larger δ. To be called if the system is singular or the model is not convex along the step.
  /// Returns false if the SQP has ended.
  bool reject_ascent();
  /// Repeats the iteration with a larger δ, which counts as another one. To be called if the line
  /// search accepts no trial point. Returns false if the SQP has ended.
  bool reject_line_search();
  /// Returns whether to restore feasibility instead of another step.
  bool wants_restoration() const { return wants_restoration_; }
  /// Returns whether to restore feasibility before the next iteration, and forgets it.
  bool take_restoration() { return std::exchange(wants_restoration_, false); }
  /// Returns whether to accept the trial point `next`, reached from `now` with step length `alpha`.
  /// If so, updates the filter and δ.
  bool accept(const Filter::Entry& now, const Filter::Entry& next, double alpha);

 private:
  bool end(SolveStatus status);
  bool regularise(SolveStatus if_hopeless);

  const ReverseConfig* config_;
  int iterations_ = 0, pivoted_ = 0;
  double proximal_;  // δ
  bool uses_lagrangian_ = true;
  SolveStatus status_ = SolveStatus::kNonFinite;
  Filter filter_;
  bool restored_ = false;  // and no step accepted since
  bool wants_restoration_ = false;
  bool closing_ = false;  // at the iteration limit
};

}  // namespace rtg::reverse
