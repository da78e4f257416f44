#pragma once

#include "core/energy/scene_model.hpp"

namespace rtg::energy {

/// Returns a pointer to the three entries of `body` in a stacked vector; null if the body is fixed.
template <class T, class V>
V* entries(const SceneModel<T>& scene, V* stacked, int body) {
  return scene.movable(body) ? stacked + 3 * body : nullptr;
}

/// Returns V y (PairFrame) of a pair for a motion `y` of all bodies [3·movable].
template <class T>
Vec4<T> pushed(const SceneModel<T>& scene, int pair, const PairFrame<T>& frame, const T* y) {
  const int i = scene.pairs()[pair].body, j = scene.pairs()[pair].other;
  return frame.pushed(entries(scene, y, i), entries(scene, y, j));
}

/// Adds Vᵀ g (PairFrame) of a pair to `into` [3·movable].
template <class T>
void pull(const SceneModel<T>& scene, int pair, const PairFrame<T>& frame, const Vec4<T>& g,
          T* into) {
  const int i = scene.pairs()[pair].body, j = scene.pairs()[pair].other;
  frame.pull(g, entries(scene, into, i), entries(scene, into, j));
}

/// Adds the blocks of a pair to a matrix, except those of fixed bodies.
template <class T>
void scatter(const SceneModel<T>& scene, int pair, const PulledBlocks<T>& blocks,
             BlockMatrix<T>& into) {
  const int i = scene.pairs()[pair].body, j = scene.pairs()[pair].other;
  if (scene.movable(i)) into.add(i, i, blocks.ii);
  if (scene.movable(j)) into.add(j, j, blocks.jj);
  if (!scene.movable(i) || !scene.movable(j)) return;
  into.add(i, j, blocks.ij);
  into.add(j, i, blocks.ji);
}

/// Adds Vᵀ H V (PairFrame) of a pair to the lower half of a symmetric matrix, except blocks of
/// fixed bodies.
template <class T>
void scatter_lower(const SceneModel<T>& scene, int pair, const PairFrame<T>& frame,
                   const Mat4<T>& H, BlockMatrix<T>& into) {
  const int i = scene.pairs()[pair].body, j = scene.pairs()[pair].other;
  const PulledBlocks<T> blocks(frame, H, frame);
  if (scene.movable(i)) into.add(i, i, blocks.ii);
  if (scene.movable(j)) into.add(j, j, blocks.jj);
  if (!scene.movable(i) || !scene.movable(j)) return;
  if (j < i)
    into.add(i, j, blocks.ij);
  else
    into.add(j, i, blocks.ji);
}

}  // namespace rtg::energy
