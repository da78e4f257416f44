#include "core/reverse/reverse_solution.hpp"

#include <algorithm>
#include <cmath>

namespace rtg::reverse {
namespace {

/// Appends the contacts that exert forces at the end of sub-step `k`.
void append_contacts(const Candidate& candidate, const Iterate& x, std::size_t k, double newton,
                     std::vector<ContactForce>& out) {
  const energy::StepEnergy& energy = candidate.problem().energy;
  const auto in_scene = [&](int body) {
    return candidate.bodies()[static_cast<std::size_t>(body)];
  };
  for (std::size_t n = 0; n < energy.contacts().size(); ++n) {
    const energy::Contact& c = energy.contacts()[n];
    const double force = newton * x.forces[k][static_cast<Eigen::Index>(n)];
    if (force <= 0.0 || energy.is_limit(c)) continue;
    const auto [point, normal] = energy.site(c, x.p[k]);
    out.push_back({static_cast<int>(k), in_scene(c.body), in_scene(c.other), point, normal, force});
  }
}

bool is_finite(const ReverseSolution& s) {
  const auto finite = [](const Vector3d& c) { return c.allFinite(); };
  return std::isfinite(s.objective + s.infeasibility + s.stationarity) &&
         std::ranges::all_of(s.trajectory, [](const Poses& p) { return rtg::is_finite(p); }) &&
         std::ranges::all_of(s.controls, finite) &&
         std::ranges::all_of(s.contacts, [](const ContactForce& c) {
           return c.point.allFinite() && c.normal.allFinite() && std::isfinite(c.force);
         });
}

}  // namespace

std::optional<ReverseSolution> solution_of(const ReverseJob& job, const Candidate& candidate,
                                           const SqpResult& solved, double newton) {
  const Iterate& x = solved.x;
  ReverseSolution out;
  for (std::size_t k = 0; k < x.p.size(); ++k) {
    out.trajectory.push_back(merged(job.end, energy::unstacked(x.p[k]), candidate.bodies()));
    append_contacts(candidate, x, k, newton, out.contacts);
  }
  if (!x.controls.empty()) out.controls.assign(x.controls.begin() + 1, x.controls.end());
  out.objective = objective(candidate.problem(), x);
  out.infeasibility = solved.infeasibility;
  out.stationarity = solved.stationarity;
  if (!is_finite(out)) return std::nullopt;
  return out;
}

}  // namespace rtg::reverse
