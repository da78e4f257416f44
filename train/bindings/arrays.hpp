#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>

#include "core/world/pose.hpp"

namespace rtg::bindings {

namespace nb = nanobind;

/// A numpy array of N states of a scene: [N, bodies, 3] float64, x [m], y [m], θ [rad].
using StateArray = nb::ndarray<const double, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using ActionArray = nb::ndarray<const std::int64_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
/// Ways of the robot: [N, 2] float64, x [m], y [m].
using WayArray = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

/// Memory that becomes a numpy array. OwnedArray owns it until release().
template <class T>
struct OwnedArray {
  std::unique_ptr<T[]> data;

  explicit OwnedArray(std::size_t count) : data(new T[count]()) {}

  /// Hands the memory over to a numpy array of the given shape and returns the array.
  nb::ndarray<nb::numpy, T> release(std::initializer_list<std::size_t> shape) {
    T* memory = data.release();
    nb::capsule owner(memory, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    return nb::ndarray<nb::numpy, T>(memory, shape, owner);
  }
};

/// Throws ValueError unless every state has one pose per body.
inline void check_bodies(const StateArray& states, std::size_t bodies) {
  if (states.shape(1) != bodies) {
    const std::string found = std::to_string(states.shape(1)), want = std::to_string(bodies);
    throw nb::value_error(
        ("states of " + found + " bodies; legal: " + want + ", the bodies of the task").c_str());
  }
}

/// Throws ValueError unless each action is from 0 to `count` - 1.
inline void check_actions(const ActionArray& actions, int count) {
  for (std::size_t row = 0; row < actions.shape(0); ++row) {
    const std::int64_t action = actions.data()[row];
    if (action < 0 || action >= count)
      throw nb::value_error(
          ("action " + std::to_string(action) + "; legal: 0 to " + std::to_string(count - 1))
              .c_str());
  }
}

/// Throws ValueError unless there is one action per state, each from 0 to `count` - 1.
inline void check_actions(const ActionArray& actions, std::size_t states, int count) {
  if (actions.shape(0) != states)
    throw nb::value_error((std::to_string(states) + " states but " +
                           std::to_string(actions.shape(0)) +
                           " actions; legal: one action per state")
                              .c_str());
  check_actions(actions, count);
}

/// Throws ValueError unless there is one way per state, each of a finite length above 0.
inline void check_ways(const WayArray& ways, std::size_t states) {
  if (ways.shape(0) != states)
    throw nb::value_error((std::to_string(states) + " states but " + std::to_string(ways.shape(0)) +
                           " ways; legal: one way per state")
                              .c_str());
  for (std::size_t row = 0; row < states; ++row) {
    const double length = std::hypot(ways.data()[2 * row], ways.data()[2 * row + 1]);
    if (!(length > 0.0) || !std::isfinite(length))
      throw nb::value_error(
          ("a way of length " + std::to_string(length) + "; legal: finite lengths above 0")
              .c_str());
  }
}

inline Poses state_at(const StateArray& states, std::size_t row) {
  const std::size_t bodies = states.shape(1);
  const double* p = states.data() + row * bodies * 3;
  Poses poses(bodies);
  for (std::size_t i = 0; i < bodies; ++i) poses[i] = {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
  return poses;
}

/// Returns the only state in `states`. Throws ValueError if there is not exactly one.
inline Poses only_state(const StateArray& states, std::size_t bodies) {
  check_bodies(states, bodies);
  if (states.shape(0) != 1)
    throw nb::value_error(
        (std::to_string(states.shape(0)) + " states; legal: one, [1, bodies, 3]").c_str());
  return state_at(states, 0);
}

/// Writes x, y, θ of each body to `out`, which has room for 3·bodies numbers; x and y in `unit`s.
inline void write_state(const Poses& poses, double* out, double unit = 1.0) {
  for (const Pose& p : poses) {
    *out++ = p.x / unit;
    *out++ = p.y / unit;
    *out++ = p.theta;
  }
}

inline nb::ndarray<nb::numpy, double> state_array(const Poses& poses) {
  OwnedArray<double> out(poses.size() * 3);
  write_state(poses, out.data.get());
  return out.release({poses.size(), 3});
}

}  // namespace rtg::bindings
