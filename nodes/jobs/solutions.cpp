#include "nodes/jobs/solutions.hpp"

#include <algorithm>
#include <numeric>

#include "nodes/bus/wire.hpp"
#include "nodes/jobs/flat_poses.hpp"

namespace rtg::jobs {
namespace {

using Message = rtg_msgs::reverse_result_t;
using reverse::ContactForce;
using reverse::ReverseSolution;

template <class T>
std::int32_t count(const std::vector<T>& values) {
  return static_cast<std::int32_t>(values.size());
}

void append(const ContactForce& c, Message& out) {
  out.contact_sub_step.push_back(static_cast<std::int16_t>(c.sub_step));
  out.contact_body.push_back(static_cast<std::int16_t>(c.body));
  out.contact_other.push_back(static_cast<std::int16_t>(c.other));
  out.contact_x.push_back(c.point.x());
  out.contact_y.push_back(c.point.y());
  out.contact_normal_x.push_back(c.normal.x());
  out.contact_normal_y.push_back(c.normal.y());
  out.contact_force.push_back(c.force);
}

void append(const ReverseSolution& s, Message& out) {
  out.sub_steps = count(s.controls);
  for (const Poses& poses : s.trajectory) append_poses(poses, out.trajectory);
  for (const Vector3d& c : s.controls) out.controls.insert(out.controls.end(), c.begin(), c.end());
  out.objective.push_back(s.objective);
  out.infeasibility.push_back(s.infeasibility);
  out.stationarity.push_back(s.stationarity);
  out.contacts.push_back(count(s.contacts));
  for (const ContactForce& c : s.contacts) append(c, out);
}

void set_counts(Message& message) {
  message.n_solutions = count(message.objective);
  message.n_trajectory = count(message.trajectory);
  message.n_controls = count(message.controls);
  message.n_contacts = count(message.contact_force);
}

/// Returns whether all values are from 0 to `most`.
bool up_to(const auto& values, int most) {
  return std::ranges::all_of(values, [most](int v) { return v >= 0 && v <= most; });
}

bool is_consistent(const Message& m, int bodies) {
  if (!up_to(m.solved, 1) || m.sub_steps < 0 || !up_to(m.contacts, m.n_contacts)) return false;
  const std::int64_t n = m.n_solutions, h = m.sub_steps;
  return std::accumulate(m.solved.begin(), m.solved.end(), std::int64_t{0}) == n &&
         std::accumulate(m.contacts.begin(), m.contacts.end(), std::int64_t{0}) == m.n_contacts &&
         m.n_trajectory == n * (h + 1) * bodies * 3 && m.n_controls == n * h * 3 &&
         up_to(m.contact_sub_step, m.sub_steps) && up_to(m.contact_body, bodies - 1) &&
         up_to(m.contact_other, bodies - 1);
}

/// Returns solution number `n`; its contacts begin at number `contact`.
ReverseSolution solution_at(const Message& m, std::size_t n, std::size_t contact, int bodies) {
  ReverseSolution s;
  const auto h = static_cast<std::size_t>(m.sub_steps);
  for (std::size_t k = 0; k <= h; ++k)
    s.trajectory.push_back(poses_at(m.trajectory, n * (h + 1) + k, bodies));
  for (std::size_t k = 0; k < h; ++k) {
    const double* c = m.controls.data() + 3 * (n * h + k);
    s.controls.emplace_back(c[0], c[1], c[2]);
  }
  for (std::size_t k = contact; k < contact + static_cast<std::size_t>(m.contacts[n]); ++k)
    s.contacts.push_back({m.contact_sub_step[k],
                          m.contact_body[k],
                          m.contact_other[k],
                          {m.contact_x[k], m.contact_y[k]},
                          {m.contact_normal_x[k], m.contact_normal_y[k]},
                          m.contact_force[k]});
  s.objective = m.objective[n];
  s.infeasibility = m.infeasibility[n];
  s.stationarity = m.stationarity[n];
  return s;
}

}  // namespace

void write_solutions(std::span<const reverse::ReverseResult> results, Message& message) {
  message.solved.assign(results.size(), 0);
  if (std::ranges::none_of(results, [](const auto& r) { return r.solution.has_value(); })) return;
  Message whole = message;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i].solution) continue;
    whole.solved[i] = 1;
    append(*results[i].solution, whole);
  }
  set_counts(whole);
  if (static_cast<std::size_t>(whole.getEncodedSize()) <= bus::kMaxMessageBytes)
    message = std::move(whole);
}

bool read_solutions(const Message& message, int bodies, std::span<reverse::ReverseResult> results) {
  if (!is_consistent(message, bodies)) return false;
  std::size_t n = 0, contact = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (message.solved[i] == 0) continue;
    results[i].solution = solution_at(message, n, contact, bodies);
    contact += static_cast<std::size_t>(message.contacts[n++]);
  }
  return true;
}

}  // namespace rtg::jobs
