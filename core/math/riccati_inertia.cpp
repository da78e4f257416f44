// Terms of the recursion in Riccati that inertia adds: they couple sub-step k with sub-step k-2.

#include "core/math/block_products.hpp"
#include "core/math/riccati.hpp"

namespace rtg {

/// Computes V, D and R'⁻¹ D. `inverse` is R'⁻¹; P_ must hold W.
template <class T>
void Riccati<T>::find_V(const Stage& stage, const BlockLdl<T>& E, const Block<T>& inverse,
                        Gain& gain) {
  const bool has_U = !stage.U.empty();
  for (int j = 0; j < M_ && has_U; ++j)
    E.solve_row([&](int k) { return transposed(stage.U, j, k); }, 0, 0, &US_[j * M_]);
  for (int i = 0; i < M_; ++i)
    for (int j = 0; j < M_; ++j) {
      RegisterSum<Block<T>> sum;
      for (const int k : Bits(stage.G.column(j)))
        with_upper(P_, M_, i, k, [&](const auto& W) { sum.add(W, stage.G.at(k, j)); });
      if (has_U) sum.subtract(US_[j * M_ + i].transpose());
      sum.store(V_[i * M_ + j]);
    }
  for (int j = 0; j < M_; ++j) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) D_[j](a, b) = stage.B[a] * V_[j](a, b);
    RegisterSum<Block<T>> scaled;
    scaled.add(inverse, D_[j]);
    scaled.store(gain.D[j]);
  }
}

/// Computes Y, Z and z of the stage before the current one.
template <class T>
void Riccati<T>::carry(const Stage& stage, const Gain& gain) {
  const bool has_U = !stage.U.empty();
  for (int i = 0; i < M_; ++i)
    for (int j = 0; j < M_; ++j) {
      RegisterSum<Block<T>> y, z;
      for (const int k : Bits(stage.G.column(j))) y.add(A_[i * M_ + k], stage.G.at(k, j));
      for (const int k : Bits(columns_[i]))
        if (has_U) y.subtract(stage.F.at(k, i).transpose(), US_[j * M_ + k].transpose());
      y.subtract(C_[i].transpose(), gain.D[j]);
      y.store(Y_[i * M_ + j]);
      if (j > i) continue;
      for (const int k : Bits(stage.G.column(i)))
        z.add(stage.G.at(k, i).transpose(), V_[k * M_ + j]);
      for (const int k : Bits(stage.G.column(j)))
        if (has_U) z.subtract(US_[i * M_ + k], stage.G.at(k, j));
      z.subtract(D_[i].transpose(), gain.D[j]);
      z.store(Z_[i * M_ + j]);
      z.store_transposed(Z_[j * M_ + i]);
    }
  carry_gradient(stage, gain);
}

template <class T>
void Riccati<T>::carry_gradient(const Stage& stage, const Gain& gain) {
  const bool has_U = !stage.U.empty();
  for (int i = 0; i < M_; ++i) {
    RegisterSum<Vec3<T>> sum;
    for (const int k : Bits(stage.G.column(i))) sum.add(stage.G.at(k, i).transpose(), w_[k]);
    for (int k = 0; k < M_ && has_U; ++k) sum.subtract(US_[i * M_ + k], stage.e[k]);
    sum.subtract(D_[i].transpose(), gain.r);
    sum.store(z_[i]);
  }
}

template void Riccati<double>::find_V(const Stage&, const BlockLdl<double>&, const Block<double>&,
                                      Gain&);
template void Riccati<Lanes>::find_V(const Stage&, const BlockLdl<Lanes>&, const Block<Lanes>&,
                                     Gain&);
template void Riccati<double>::carry(const Stage&, const Gain&);
template void Riccati<Lanes>::carry(const Stage&, const Gain&);

}  // namespace rtg
