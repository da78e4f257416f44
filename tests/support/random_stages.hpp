#pragma once

#include "core/math/rng.hpp"
#include "core/math/stage_system.hpp"

namespace rtg::testing {

/// Random blocks of ±size, `diagonal` added on the matrix's own.
struct RandomBlocks {
  double size = 0.0, diagonal = 0.0;
  bool symmetric = false;  // the lower half, blocks on the diagonal symmetric

  /// Fills lane l of what couples bodies at most `reach` places apart.
  template <class T>
  void fill(BlockMatrix<T>& A, int l, int reach, Rng& rng) const {
    for (int i = 0; i < A.M; ++i)
      for (int j = 0; j < (symmetric ? i + 1 : A.M); ++j) {
        if (std::abs(i - j) > reach) continue;
        if (!A.has(i, j)) A.add(i, j, Block<T>(Block<T>::Constant(T(0.0))));
        fill_block(A.at(i, j), l, i == j, rng);
      }
  }

 private:
  template <class T>
  void fill_block(Block<T>& block, int l, bool own, Rng& rng) const {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        if (symmetric && own && b > a) continue;
        const double x = size * rng.uniform(-1.0, 1.0) + (own && a == b ? diagonal : 0.0);
        set_lane(block(a, b), l, x);
        if (symmetric && own) set_lane(block(b, a), l, x);
      }
  }
};

/// Chooses what randomise() makes.
enum class Levels { kTwo, kThree };  // kThree: with G and U, as inertia has them

/// A well-conditioned system in lane l; bodies are coupled with those at most `reach` places away.
template <class T>
void randomise(StageSystem<T>& system, int l, int reach, std::uint64_t seed,
               Levels levels = Levels::kTwo) {
  Rng rng(seed);
  const auto vector = [&](BlockColumn<T>& v) {
    for (Vec3<T>& block : v)
      for (int m = 0; m < 3; ++m) set_lane(block[m], l, rng.uniform(-1.0, 1.0));
  };
  for (auto& stage : system.stages) {
    if (levels == Levels::kThree && &stage - system.stages.data() > 1) {
      RandomBlocks{0.1, 0.4, false}.fill(stage.G, l, 0, rng);
      RandomBlocks{0.1, 0.0, false}.fill(stage.U, l, 0, rng);
    }
    RandomBlocks{0.2, 2.0, true}.fill(stage.Q, l, reach, rng);
    RandomBlocks{0.2, 2.0, true}.fill(stage.E, l, reach, rng);
    RandomBlocks{0.2, -1.0, false}.fill(stage.F, l, reach, rng);
    RandomBlocks{0.1, 0.0, false}.fill(stage.N, l, reach, rng);
    vector(stage.q);
    vector(stage.e);
    for (int m = 0; m < 3; ++m) {
      set_lane(stage.R[m], l, rng.uniform(0.4, 0.6));
      set_lane(stage.B[m], l, rng.uniform(0.9, 1.1));
      set_lane(stage.r[m], l, rng.uniform(-1.0, 1.0));
    }
  }
}

}  // namespace rtg::testing
