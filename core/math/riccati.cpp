#include "core/math/riccati.hpp"

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
      A_(P_),
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
      Ne_(v_),
      row_(C_),
      whole_(count) {}

template <class T>
Mask<T> Riccati<T>::solve(const StageSystem<T>& system, StageStep<T>& step) {
  regular_ = Mask<T>(true);
  set_end(system.stages.back());
  for (int k = system.h; k > 0; --k) eliminate(system.stages[k], system.stages[k - 1], k);
  for (int i = 0; i < M_; ++i)
    for (int j = 0; j <= i; ++j) whole_.add(i, j, P_[j * M_ + i].transpose());
  start_.factorize(whole_);
  whole_.clear();
  roll_forward(system, step);
  find_multipliers(system, step);
  return regular_ && start_.regular();
}

/// Sets P and v of the last stage.
template <class T>
void Riccati<T>::set_end(const Stage& stage) {
  for (int i = 0; i < M_; ++i)
    for (int j = i; j < M_; ++j) transposed(stage.Q, i, j).store(P_[i * M_ + j]);
  v_ = stage.q;
  has_Y_ = false;
}

/// Overwrites P with W = S P S.
template <class T>
void Riccati<T>::sandwich(const BlockLdl<T>& E) {
  const auto loaded = [](const auto& block) { return RegisterSum<Block<T>>(block); };
  for (int i = 0; i < M_; ++i)  // P S
    E.solve_row([&](int j) { return with_upper(P_, M_, i, j, loaded); }, 0, 0, &X_[i * M_]);
  for (int i = 0; i < M_; ++i)
    E.solve_row([&](int j) { return RegisterSum<Block<T>>(X_[j * M_ + i].transpose()); }, 0, i,
                &P_[i * M_]);
}

/// Computes row `i` of X, A, C and N̂ᵀ S e. Of the row of A it stores all blocks if the stage has
/// G, otherwise only the first.
template <class T>
void Riccati<T>::couple(const Stage& stage, const BlockLdl<T>& E, int i) {
  find_NS(stage, E, i);
  RegisterSum<Vec3<T>> product;
  for (int j = 0; j < M_; ++j) {
    product.add(row_[j], stage.e[j]);
    RegisterSum<Block<T>> sum;
    for (const int k : Bits(columns_[i]))
      with_upper(P_, M_, k, j, [&](const auto& W) { sum.add(stage.F.at(k, i).transpose(), W); });
    if (j == 0 || has_G_) {
      RegisterSum<Block<T>> whole = sum;
      whole.subtract(row_[j]);
      whole.store(A_[i * M_ + j]);
    }
    sum.scale(T(0.5));
    sum.subtract(row_[j]);
    sum.store(X_[i * M_ + j]);
  }
  product.store(Ne_[i]);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) C_[i](a, b) = stage.B[a] * A_[i * M_](b, a);
}

/// row_ ← row i of N̂ᵀ S.
template <class T>
void Riccati<T>::find_NS(const Stage& stage, const BlockLdl<T>& E, int i) {
  const std::uint64_t column = stage.N.column(i);
  const int first = has_Y_ ? 0 : std::min(std::countr_zero(column), M_);
  const auto load = [&](int k) {
    RegisterSum<Block<T>> sum = transposed(stage.N, i, k);
    if (has_Y_) sum.add(Y_[k * M_ + i].transpose());
    return sum;
  };
  E.solve_row(load, first, 0, row_.data());
}

template <class T>
void Riccati<T>::eliminate(const Stage& stage, const Stage& before, int k) {
  BlockLdl<T>& E = E_[k];
  E.factorize(stage.E);
  regular_ = regular_ && E.regular();
  for (int j = 0; j < M_; ++j) columns_[j] = stage.F.column(j);
  has_G_ = !stage.G.empty();
  sandwich(E);
  E.solve(v_.data());  // S v
  for (int i = 0; i < M_; ++i) couple(stage, E, i);
  find_w(stage);
  const Block<T> inverse = find_gain(stage, gain_[k]);
  fold_gradient(before, stage, gain_[k]);
  if (has_G_) find_V(stage, E, inverse, gain_[k]);
  fold_hessian(before, stage, gain_[k]);
  has_Y_ = has_G_;
  if (has_Y_) carry(stage, gain_[k]);
}

/// Computes w. v_ must hold S v.
template <class T>
void Riccati<T>::find_w(const Stage& stage) {
  for (int i = 0; i < M_; ++i) {
    RegisterSum<Vec3<T>> sum;
    for (int j = 0; j < M_; ++j)
      with_upper(P_, M_, i, j, [&](const auto& W) { sum.add(W, stage.e[j]); });
    sum.subtract(v_[i]);
    sum.store(w_[i]);
  }
}

/// Computes R'⁻¹ C and R'⁻¹ r'. Returns R'⁻¹.
template <class T>
Block<T> Riccati<T>::find_gain(const Stage& stage, Gain& gain) {
  Block<T> R = P_[0];
  Vec3<T> r = stage.r;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) R(a, b) = R(a, b) * stage.B[a] * stage.B[b];
    R(a, a) += stage.R[a];
    r[a] = r[a] + stage.B[a] * w_[0][a];
  }
  const SymmetricInverse<T> inverted(R);
  const Block<T>& inverse = inverted.inverse;
  regular_ = regular_ && inverted.regular;
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

/// Computes P of the stage `before` the current one.
template <class T>
void Riccati<T>::fold_hessian(const Stage& before, const Stage& stage, const Gain& gain) {
  for (int i = 0; i < M_; ++i)
    for (int j = i; j < M_; ++j) {
      RegisterSum<Block<T>> sum = transposed(before.Q, i, j);
      if (has_Y_) sum.add(Z_[i * M_ + j]);
      for (const int k : Bits(columns_[j])) sum.add(X_[i * M_ + k], stage.F.at(k, j));
      for (const int k : Bits(columns_[i]))
        sum.add(stage.F.at(k, i).transpose(), X_[j * M_ + k].transpose());
      sum.subtract(C_[i].transpose(), gain.C[j]);
      sum.store(P_[i * M_ + j]);
    }
}

/// Computes v of the stage `before` the current one.
template <class T>
void Riccati<T>::fold_gradient(const Stage& before, const Stage& stage, const Gain& gain) {
  for (int i = 0; i < M_; ++i) {
    RegisterSum<Vec3<T>> sum(before.q[i]);
    for (const int m : Bits(columns_[i])) sum.add(stage.F.at(m, i).transpose(), w_[m]);
    sum.subtract(C_[i].transpose(), gain.r);
    sum.subtract(Ne_[i]);
    if (has_Y_) sum.add(z_[i]);
    sum.store(v_[i]);
  }
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
    const bool has_G = !stage.G.empty();
    for (int j = 0; j < M_ && has_G; ++j) control.subtract(gain_[k].D[j], step.poses[k - 2][j]);
    Vec3<T>& c = step.controls[k];
    control.store(c);
    BlockColumn<T>& p = step.poses[k];
    for (int i = 0; i < M_; ++i) {
      RegisterSum<Vec3<T>> sum(stage.e[i]);
      add_row(sum, stage.F, i, before);
      if (has_G) add_row(sum, stage.G, i, step.poses[k - 2]);
      sum.store(p[i]);
    }
    for (int a = 0; a < 3; ++a) p[0][a] = p[0][a] + stage.B[a] * c[a];
    for (Vec3<T>& block : p) block = -block;
    E_[k].solve(p.data());
  }
}

/// Computes the multipliers Δy_k, from the last sub-step to the first. Each follows from
/// stationarity in Δp_k:
///   Q Δp_k + q + N_k Δp_{k-1} + U_k Δp_{k-2} + N_{k+1}ᵀ Δp_{k+1} + U_{k+2}ᵀ Δp_{k+2}
///     + E Δy_k + F_{k+1}ᵀ Δy_{k+1} + G_{k+2}ᵀ Δy_{k+2} = 0.
template <class T>
void Riccati<T>::find_multipliers(const StageSystem<T>& system, StageStep<T>& step) const {
  for (int k = system.h; k > 0; --k) {
    const Stage& stage = system.stages[k];
    BlockColumn<T>& y = step.multipliers[k];
    for (int i = 0; i < M_; ++i) {
      RegisterSum<Vec3<T>> sum(stage.q[i]);
      add_symmetric_row(sum, stage.Q, i, step.poses[k]);
      add_row(sum, stage.N, i, step.poses[k - 1]);
      if (!stage.U.empty()) add_row(sum, stage.U, i, step.poses[k - 2]);
      if (k < system.h) {
        const Stage& next = system.stages[k + 1];
        add_column(sum, next.N, i, step.poses[k + 1]);
        add_column(sum, next.F, i, step.multipliers[k + 1]);
      }
      if (k + 2 <= system.h) {
        const Stage& next = system.stages[k + 2];
        add_column(sum, next.U, i, step.poses[k + 2]);
        add_column(sum, next.G, i, step.multipliers[k + 2]);
      }
      sum.store(y[i]);
    }
    for (Vec3<T>& block : y) block = -block;
    E_[k].solve(y.data());
  }
}

template class Riccati<double>;
template class Riccati<Lanes>;

}  // namespace rtg
