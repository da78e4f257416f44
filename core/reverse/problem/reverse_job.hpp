#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/hash.hpp"
#include "core/math/vectors.hpp"
#include "core/reverse/problem/solve_status.hpp"
#include "core/world/pose.hpp"

namespace rtg::reverse {

/// A request for the predecessors of a state: the states from which the push `action` leads to
/// `end`.
struct ReverseJob {
  Poses end;
  int action = 0;
  bool with_solution = false;  // the result is to hold the whole solution

  bool operator==(const ReverseJob&) const = default;
};

/// Returns a hash of a state and an action. Two different pairs have equal hashes with probability
/// 2⁻⁶⁴.
inline std::uint64_t key_of(const Poses& state, int action) {
  std::uint64_t key = hashed(0, static_cast<std::uint64_t>(action));
  for (const Pose& p : state)
    for (const double x : {p.x, p.y, p.theta}) key = hashed(key, std::bit_cast<std::uint64_t>(x));
  return key;
}
inline std::uint64_t key_of(const ReverseJob& job) { return key_of(job.end, job.action); }

/// Largest number of predecessors in the answer to one job.
inline constexpr int kMaxPredecessors = 8;

/// A contact that exerts a force.
struct ContactForce {
  int sub_step = 0;        // at whose end it does; 0: at the start of the push
  int body = 0;            // on which the force acts
  int other = 0;           // which exerts it
  Vector2d point, normal;  // energy::ContactSite, in the world frame
  double force = 0.0;      // normal force λ [N]

  bool operator==(const ContactForce&) const = default;
};

/// Where the SQP of a reverse problem ended (ReverseProblem); converged or not. Bodies that the
/// push cannot reach rest. Forces at the limits of joints are not listed.
struct ReverseSolution {
  std::vector<Poses> trajectory;       // p_0 ... p_h
  std::vector<Vector3d> controls;      // c_1 ... c_h, before tanh
  std::vector<ContactForce> contacts;  // by sub-step
  double objective = 0.0;              // J [kg m²]
  double infeasibility = 0.0;          // ‖C‖∞ [kg m], [kg m²]
  double stationarity = 0.0;           // ‖∇L‖∞

  bool operator==(const ReverseSolution&) const = default;
};

/// Answer to a ReverseJob. If has_predecessors(status), `predecessors` holds 1 to kMaxPredecessors
/// finite predecessors. Otherwise it is empty. ReverseSimulator puts the start of the whole push
/// first.
struct ReverseResult {
  SolveStatus status = SolveStatus::kNonFinite;
  int iterations = 0;  // of the SQP, at all paces (pace.hpp)
  std::vector<Poses> predecessors = {};
  double cpu_s = 0.0;  // thread CPU time; the one field that is not a function of the job
  // If it was asked for, a problem was solved and it is finite.
  std::optional<ReverseSolution> solution = {};
};

}  // namespace rtg::reverse
