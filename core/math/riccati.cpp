#include "core/math/riccati.hpp"

#include <algorithm>

#include "core/math/block_products.hpp"

namespace rtg {
template <class T>
Riccati<T>::Riccati(int count, int sub_steps)
    : M_(count),
      E_(static_cast<std::size_t>(sub_steps) + 1, BlockLdl<T>(count)),
      start_(count),
      gain_(E_.size(), Gain{std::vector<Block<T>>(static_cast<std::size_t>(count)),
                            std::vector<Block<T>>(static_cast<std::size_t>(count)),
                            Vec3<T>::Constant(T(0.0))}),
      P_(static_cast<std::size_t>(count) * static_cast<std::size_t>(count)),
      X_(P_),
      T_(P_),
      Y_(P_),
      Z_(P_),
      V_(P_),
      US_(P_),
      columns_(static_cast<std::size_t>(count)),
      C_(static_cast<std::size_t>(count)),
      D_(C_),
      v_(static_cast<std::size_t>(count)),
      w_(v_),
      z_(v_),
      Se_(v_),
      row_(C_),
      whole_(count) {}

template <class T>
Mask<T> Riccati<T>::solve(const StageSystem<T>& system, StageStep<T>& step) {
  regular_ = Mask<T>(true);
  set_end(system.stages.back());
  for (int k = system.h; k > 0; --k) eliminate(system.stages[k], system.stages[k - 1], k);
  for (int i = 0; i < M_; ++i)
    for (int j = 0; j <= i; ++j) whole_.add(i, j, P_[i * M_ + j]);
  start_.factorize(whole_);
  whole_.clear();
  roll_forward(system, step);
  find_multipliers(system, step);
  return regular_ && start_.regular();
}

/// P and v of the last stage.
template <class T>
void Riccati<T>::set_end(const Stage& stage) {
  for (int i = 0; i < M_; ++i)
    for (int j = 0; j <= i; ++j) {
      const bool has = stage.Q.has(i, j);
      const RegisterSum<Block<T>> own =
          has ? RegisterSum<Block<T>>(stage.Q.at(i, j)) : RegisterSum<Block<T>>();
      own.store(P_[i * M_ + j]);
      own.store_transposed(P_[j * M_ + i]);
    }
  v_ = stage.q;
  carries_ = false;
}

/// P ← W. Row by row, each in and out once: what is worked on stays in the fastest cache.
template <class T>
void Riccati<T>::sandwich(const BlockLdl<T>& E) {
  for (int i = 0; i < M_; ++i) {  // P S, transposed
    std::copy_n(P_.begin() + i * M_, M_, row_.begin());
    E.solve_row(row_.data(), 0, 0);
    for (int j = 0; j < M_; ++j) X_[j * M_ + i] = row_[j].transpose();
  }
  for (int i = 0; i < M_; ++i) {  // times S, a symmetric product
    std::copy_n(X_.begin() + i * M_, M_, row_.begin());
    E.solve_row(row_.data(), 0, i);
    for (int j = i; j < M_; ++j) {
      P_[i * M_ + j] = row_[j];
      if (j > i) P_[j * M_ + i] = row_[j].transpose();
    }
  }
}

/// C, and X + ½ Z, row by row.
template <class T>
void Riccati<T>::couple(const Stage& stage, const BlockLdl<T>& E) {
  for (int i = 0; i < M_; ++i) {
    find_coupling(stage, E, i);
    for (int j = 0; j < M_; ++j) {
      RegisterSum<Block<T>> sum =
          carries_ ? RegisterSum<Block<T>>(Z_[i * M_ + j]) : RegisterSum<Block<T>>();
      if (carries_) sum.scale(T(0.5));
      for (const int k : Bits(columns_[j])) sum.add(row_[k], stage.F.at(k, j));
      sum.store(X_[i * M_ + j]);
    }
  }
}

/// row_ ← row i of ½ Fᵀ W - N̂ᵀ S; block i of C; row i of T, all of it where the stage reaches back.
template <class T>
void Riccati<T>::find_coupling(const Stage& stage, const BlockLdl<T>& E, int i) {
  int first = M_;
  for (int k = M_; k-- > 0;) {
    const bool has = stage.N.has(k, i);
    if (has || carries_) first = k;
    if (carries_)
      row_[k] = Y_[k * M_ + i].transpose();
    else
      row_[k].setConstant(T(0.0));
    if (has) row_[k] += stage.N.at(k, i).transpose();
  }
  if (first < M_) E.solve_row(row_.data(), first, 0);
  for (int j = 0; j < M_; ++j) {
    RegisterSum<Block<T>> sum;
    for (const int k : Bits(columns_[i])) sum.add(stage.F.at(k, i).transpose(), P_[k * M_ + j]);
    if (j == 0 || reaches_) {
      RegisterSum<Block<T>> whole = sum;
      whole.subtract(row_[j]);
      whole.store(T_[i * M_ + j]);
    }
    sum.scale(T(0.5));
    sum.subtract(row_[j]);
    sum.store(row_[j]);
  }
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) C_[i](a, b) = stage.B[a] * T_[i * M_](b, a);
}

template <class T>
void Riccati<T>::eliminate(const Stage& stage, const Stage& before, int k) {
  BlockLdl<T>& E = E_[k];
  E.factorize(stage.E);
  regular_ = regular_ && E.regular();
  for (std::uint64_t& column : columns_) column = 0;
  for (int i = 0; i < M_; ++i)
    for (const int j : Bits(stage.F.pattern[i])) columns_[j] |= std::uint64_t{1} << i;
  reaches_ = !stage.G.empty();
  sandwich(E);
  couple(stage, E);
  E.solve(v_.data());  // S v
  for (int i = 0; i < M_; ++i) {
    RegisterSum<Vec3<T>> sum(-v_[i]);
    for (int j = 0; j < M_; ++j) sum.add(P_[i * M_ + j], stage.e[j]);
    sum.store(w_[i]);
  }
  const Block<T> inverse = find_gain(stage, gain_[k]);
  Se_ = stage.e;
  E.solve(Se_.data());
  fold_gradient(stage, before, gain_[k]);
  carries_ = reaches_;
  if (carries_) reach_back(stage, E, inverse, gain_[k]);
  fold_hessian(before, gain_[k]);
}

/// R'⁻¹ C and R'⁻¹ r'; returns R'⁻¹.
template <class T>
Block<T> Riccati<T>::find_gain(const Stage& stage, Gain& gain) {
  Block<T> R = P_[0];
  Vec3<T> r = stage.r;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) R(a, b) = R(a, b) * stage.B[a] * stage.B[b];
    R(a, a) += stage.R[a];
    r[a] = r[a] + stage.B[a] * w_[0][a];
  }
  T determinant;
  const Block<T> inverse = symmetric_inverse(R, determinant);
  regular_ = regular_ && is_regular(R, determinant);
  RegisterSum<Vec3<T>> product;
  product.add(inverse, r);
  product.store(gain.r);
  for (int j = 0; j < M_; ++j) {
    RegisterSum<Block<T>> scaled;
    scaled.add(inverse, C_[j]);
    scaled.store(gain.C[j]);
  }
  return inverse;
}

/// P of the stage before.
template <class T>
void Riccati<T>::fold_hessian(const Stage& before, const Gain& gain) {
  for (int i = 0; i < M_; ++i)
    for (int j = 0; j <= i; ++j) {
      RegisterSum<Block<T>> sum(X_[i * M_ + j]);
      sum.add_transposed(X_[j * M_ + i]);
      if (before.Q.has(i, j)) sum.add(before.Q.at(i, j));
      sum.subtract(C_[i].transpose(), gain.C[j]);
      sum.store(P_[i * M_ + j]);
      if (j < i) sum.store_transposed(P_[j * M_ + i]);
    }
}

/// v of the stage before.
template <class T>
void Riccati<T>::fold_gradient(const Stage& stage, const Stage& before, const Gain& gain) {
  for (int i = 0; i < M_; ++i) {
    RegisterSum<Vec3<T>> sum(before.q[i]);
    for (const int m : Bits(columns_[i])) sum.add(stage.F.at(m, i).transpose(), w_[m]);
    sum.subtract(C_[i].transpose(), gain.r);
    for (int m = 0; m < M_ && carries_; ++m) sum.subtract(Y_[m * M_ + i].transpose(), Se_[m]);
    sum.store(v_[i]);
    if (carries_) v_[i] += z_[i];
  }
  subtract_transposed(v_, stage.N, Se_);
}

template <class T>
void Riccati<T>::roll_forward(const StageSystem<T>& system, StageStep<T>& step) const {
  for (int i = 0; i < M_; ++i) step.poses[0][i] = -v_[i];
  start_.solve(step.poses[0].data());
  for (int k = 1; k <= system.h; ++k) {
    const Stage& stage = system.stages[k];
    const BlockColumn<T>& before = step.poses[k - 1];
    RegisterSum<Vec3<T>> control(-gain_[k].r);
    for (int j = 0; j < M_; ++j) control.subtract(gain_[k].C[j], before[j]);
    const bool reaches = !stage.G.empty();
    for (int j = 0; j < M_ && reaches; ++j) control.subtract(gain_[k].D[j], step.poses[k - 2][j]);
    Vec3<T>& c = step.controls[k];
    control.store(c);
    BlockColumn<T>& p = step.poses[k];
    p = stage.e;
    add_to(p, stage.F, before);
    if (reaches) add_to(p, stage.G, step.poses[k - 2]);
    for (int a = 0; a < 3; ++a) p[0][a] = p[0][a] + stage.B[a] * c[a];
    for (Vec3<T>& block : p) block = -block;
    E_[k].solve(p.data());
  }
}

/// Stationarity in Δp_k, from the last sub-step to the first:
///   Q Δp_k + q + N_k Δp_{k-1} + U_k Δp_{k-2} + N_{k+1}ᵀ Δp_{k+1} + U_{k+2}ᵀ Δp_{k+2}
///     + E Δy_k + F_{k+1}ᵀ Δy_{k+1} + G_{k+2}ᵀ Δy_{k+2} = 0.
template <class T>
void Riccati<T>::find_multipliers(const StageSystem<T>& system, StageStep<T>& step) const {
  for (int k = system.h; k > 0; --k) {
    const Stage& stage = system.stages[k];
    BlockColumn<T>& y = step.multipliers[k];
    y = stage.q;
    add_symmetric_to(y, stage.Q, step.poses[k]);
    add_to(y, stage.N, step.poses[k - 1]);
    if (!stage.U.empty()) add_to(y, stage.U, step.poses[k - 2]);
    if (k < system.h) {
      const Stage& next = system.stages[k + 1];
      add_transposed_to(y, next.N, step.poses[k + 1]);
      add_transposed_to(y, next.F, step.multipliers[k + 1]);
    }
    if (k + 2 <= system.h) {
      const Stage& next = system.stages[k + 2];
      add_transposed_to(y, next.U, step.poses[k + 2]);
      add_transposed_to(y, next.G, step.multipliers[k + 2]);
    }
    for (Vec3<T>& block : y) block = -block;
    E_[k].solve(y.data());
  }
}

template class Riccati<double>;
template class Riccati<Lanes>;

}  // namespace rtg
