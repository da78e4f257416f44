#pragma once

#include <span>

#include "core/search/transition.hpp"
#include "train/bindings/arrays.hpp"

namespace rtg::bindings {

/// Returns the columns of transitions as a tuple of arrays: poses [N, bodies, 3], action [N], next
/// poses, success [N], source [N].
inline nb::tuple transition_arrays(std::span<const search::Transition> rows) {
  const std::size_t count = rows.size(), bodies = count ? rows[0].poses.size() : 0;
  OwnedArray<double> poses(count * bodies * 3), next(count * bodies * 3);
  OwnedArray<std::int32_t> action(count);
  OwnedArray<bool> success(count);
  OwnedArray<std::int8_t> source(count);
  for (std::size_t k = 0; k < count; ++k) {
    write_state(rows[k].poses, poses.data.get() + k * bodies * 3);
    write_state(rows[k].next, next.data.get() + k * bodies * 3);
    action.data[k] = rows[k].action;
    success.data[k] = rows[k].success;
    source.data[k] = static_cast<std::int8_t>(rows[k].source);
  }
  return nb::make_tuple(poses.release({count, bodies, 3}), action.release({count}),
                        next.release({count, bodies, 3}), success.release({count}),
                        source.release({count}));
}

}  // namespace rtg::bindings
