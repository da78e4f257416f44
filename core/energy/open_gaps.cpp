#include "core/energy/open_gaps.hpp"

#include <algorithm>

namespace rtg {
namespace {

constexpr int kRounds = 50;

}  // namespace

double least_gap(const StepEnergy& energy, const VectorXd& p) {
  double least = energy.barrier().range;
  for (const Contact& c : energy.contacts())
    if (energy.near(c, p)) least = std::min(least, energy.gap_value(c, p));
  return least;
}

VectorXd with_open_gaps(const StepEnergy& energy, VectorXd p) {
  const double floor = kGapFloor * energy.barrier().range;
  bool open = false;
  for (int round = 0; round < kRounds && !open; ++round) {
    open = true;
    for (const Contact& c : energy.contacts()) {
      if (!energy.near(c, p)) continue;
      const Gap<double> g = energy.gap(c, energy.point(c, p));
      if (g.value >= floor) continue;
      open = false;
      VectorXd slope = VectorXd::Zero(energy.dofs());
      scatter(energy, c, g.gradient, slope);
      p.head(energy.dofs()) += (1.1 * floor - g.value) / slope.squaredNorm() * slope;
    }
  }
  return p;
}

}  // namespace rtg
