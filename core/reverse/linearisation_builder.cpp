#include "core/reverse/linearisation_builder.hpp"

namespace rtg {
namespace {

constexpr double kMultiplierShift = 1e-9;  // on the multipliers' diagonal, against a singular Φ_p
constexpr double kForceProximal = 0.01;    // share of δ on the forces

template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> along(const Eigen::Matrix<Dual, Rows, Columns>& M) {
  return M.unaryExpr([](const Dual& x) { return x.d; });
}

Mat6<double> symmetric_product(const Vec6<double>& a, const Vec6<double>& b) {
  return a * b.transpose() + b * a.transpose();
}

}  // namespace

LinearisationBuilder::LinearisationBuilder(Linearisation& into, const Iterate& x,
                                           const Curvature& curvature)
    : lin_(into),
      problem_(*into.problem_),
      energy_(into.problem_->energy),
      x_(x),
      curvature_(curvature),
      h_(into.h_),
      n_(into.n_) {
  const auto levels = static_cast<std::size_t>(h_) + 1;
  lin_.pose_gradient_.assign(levels, VectorXd::Zero(n_));
  lin_.objective_pose_ = lin_.pose_gradient_;
  lin_.control_gradient_.assign(levels, Vector3d::Zero());
  lin_.objective_control_ = lin_.control_gradient_;
  const int blocks = problem_.fixed_end() ? h_ : h_ + 1;
  for (int k = 0; k < blocks; ++k) {
    const int rows = k == 0 && !problem_.fixed_end() ? n_ : 2 * n_ + 3;
    lin_.K_.A.push_back(MatrixXd::Zero(rows, rows));
    lin_.K_.B.push_back(k == 0 ? MatrixXd() : MatrixXd::Zero(rows, lin_.K_.A[k - 1].cols()));
  }
}

void LinearisationBuilder::run() {
  add_objective();
  for (int k = 0; k <= h_; ++k) {
    lin_.pose_gradient_[k] = lin_.objective_pose_[k];
    lin_.control_gradient_[k] = lin_.objective_control_[k];
  }
  for (int k = 1; k <= h_; ++k) {
    add_damping(k);
    add_control(k);
  }
  for (int k = 0; k <= h_; ++k)
    for (int c = 0; c < static_cast<int>(energy_.contacts().size()); ++c)
      if (may_act(problem_, x_, k, c)) add_contact(k, c);
  add_proximal();
  for (MatrixXd& A : lin_.K_.A)  // so far ∂Φ stands below the diagonal only
    A = MatrixXd(A.selfadjointView<Eigen::Lower>());
}

void LinearisationBuilder::add_damping(int k) {
  const VectorXd& y = x_.multipliers[k];
  const Linearisation::Place row = lin_.multiplier_place(k);
  const Linearisation::Place here = lin_.pose_place(k), before = lin_.pose_place(k - 1);
  for (int i = 0; 3 * i < n_; ++i) {
    const Damping& body = energy_.damping(i);
    const double turn = x_.p[k][3 * i + 2] - x_.p[k - 1][3 * i + 2];
    const Vector3d slope(body.mass, body.mass, body.turn_curvature(turn));
    const Vector3d force = slope.cwiseProduct(y.segment<3>(3 * i));
    lin_.pose_gradient_[k].segment<3>(3 * i) += force;
    lin_.pose_gradient_[k - 1].segment<3>(3 * i) -= force;
    for (int m = 3 * i; m < 3 * i + 3; ++m) {
      if (lin_.has_pose(k)) entry(row, m, here, m) += slope[m - 3 * i];
      entry(row, m, before, m) -= slope[m - 3 * i];
    }
    if (!curvature_.exact) continue;
    const int m = 3 * i + 2;
    const double bend = body.turn_third(turn) * y[m];
    entry(before, m, before, m) += bend;
    if (!lin_.has_pose(k)) continue;
    entry(here, m, here, m) += bend;
    entry(here, m, before, m) -= bend;
  }
}

void LinearisationBuilder::add_control(int k) {
  const Vector3d push = x_.controls[k].array().tanh();
  const Vector3d slope = -energy_.control_bound().array() * (1.0 - push.array().square());
  const Vector3d y = x_.multipliers[k].head<3>();
  const Linearisation::Place row = lin_.multiplier_place(k), at = lin_.control_place(k);
  lin_.control_gradient_[k] += slope.cwiseProduct(y);
  for (int m = 0; m < 3; ++m) {
    entry(row, m, at, m) += slope[m];
    if (curvature_.exact) entry(at, m, at, m) -= 2.0 * push[m] * slope[m] * y[m];
  }
}

void LinearisationBuilder::add_objective() {
  const ReverseConfig& config = problem_.config;
  for (int i = 0; 3 * i < n_; ++i)
    lin_.objective_pose_[0].segment<2>(3 * i) =
        (i == 0 ? config.robot_weight : config.object_weight) * problem_.direction;
  const Vector3d weight =
      2.0 * Vector3d(config.path_weight, config.path_weight, config.heading_weight);
  for (int k = 0; k <= h_; ++k) {
    const Vector3d off = x_.p[k].head<3>() - problem_.robot_path(k);
    lin_.objective_pose_[k].head<3>() += weight.cwiseProduct(off);
    if (lin_.has_pose(k)) lin_.K_.A[k].diagonal().head<3>() += weight;
    if (k == 0) continue;
    lin_.objective_control_[k] = 2.0 * config.control_weight * x_.controls[k];
    const Linearisation::Place at = lin_.control_place(k);
    for (int m = 0; m < 3; ++m) entry(at, m, at, m) += 2.0 * config.control_weight;
  }
  if (lin_.has_pose(h_)) {
    lin_.objective_pose_[h_] += config.terminal_weight * (x_.p[h_] - problem_.end).head(n_);
    lin_.K_.A[h_].diagonal().head(n_).array() += config.terminal_weight;
  }
  for (int k = 1; k <= h_; ++k)
    for (int i = 1; 3 * i < n_; ++i) add_speed(k, i);
  add_start_barrier();
}

void LinearisationBuilder::add_speed(int k, int i) {
  const SpeedPenalty speed = problem_.speed(x_.p, k, i);
  lin_.objective_pose_[k].segment<3>(3 * i) += speed.gradient;
  lin_.objective_pose_[k - 1].segment<3>(3 * i) -= speed.gradient;
  const Linearisation::Place here = lin_.pose_place(k), before = lin_.pose_place(k - 1);
  for (int m = 0; m < 3; ++m)
    for (int n = 0; n < 3; ++n) {
      const double bend = speed.hessian(m, n);
      entry(before, 3 * i + m, before, 3 * i + n) += bend;
      if (!lin_.has_pose(k)) continue;
      entry(here, 3 * i + m, here, 3 * i + n) += bend;
      entry(here, 3 * i + m, before, 3 * i + n) -= bend;
    }
}

/// Σ b(g(p_0)).
void LinearisationBuilder::add_start_barrier() {
  const Barrier& barrier = energy_.barrier();
  for (const Contact& c : energy_.contacts()) {
    if (!energy_.near(c, x_.p[0])) continue;
    const LocalPoint<double> here = energy_.point(c, x_.p[0]);
    if (!barrier.acts(energy_.gap_value(c, here))) continue;
    const Gap<double> g = energy_.gap(c, here);
    const double force = barrier.force(g.value);
    scatter(energy_, c, Vec6<double>(-force * g.gradient), lin_.objective_pose_[0]);
    Mat6<double> H = -barrier.force_slope(g.value) * g.gradient * g.gradient.transpose();
    if (curvature_.exact) H -= force * g.hessian;
    to_hessian(c, H, 0);
  }
}

void LinearisationBuilder::add_contact(int level, int contact) {
  const Contact& c = energy_.contacts()[contact];
  const LocalPoint<double> here = energy_.point(c, x_.p[level]);
  const double force = x_.forces[level][contact];
  if (force == 0.0 && !energy_.barrier().acts(energy_.gap_value(c, here))) return;
  const Gap<double> g = energy_.gap(c, here);
  const double s = force - energy_.barrier().weight * energy_.barrier().window(g.value).d1;
  Linearisation::Eliminated e;
  e.level = level;
  e.contact = contact;
  e.gap = g.value;
  e.b = lin_.has_pose(level) ? Vec6<double>(-s / g.value * g.gradient) : Vec6<double>::Zero();
  e.normal = level > 0 ? Vec6<double>(-g.gradient) : Vec6<double>::Zero();
  e.friction = e.now = e.next = Vec6<double>::Zero();
  force_gradient_ = 0.0;
  if (level > 0) add_normal_force(c, g, e);
  if (level < h_) add_friction(c, here, e);
  if (curvature_.exact && level > 0) add_exact_normal(c, e);
  if (curvature_.exact && level < h_) add_exact_friction(c, e);
  eliminate(c, g, e);
  lin_.eliminated_.push_back(e);
}

/// -λ ∇g(p_k) in Φ_k.
void LinearisationBuilder::add_normal_force(const Contact& c, const Gap<double>& g,
                                            Linearisation::Eliminated& e) {
  const double force = x_.forces[e.level][e.contact];
  const Vec6<double> y = gather(energy_, c, x_.multipliers[e.level]);
  to_jacobian(c, -force * g.hessian + e.normal * e.b.transpose(), e.level);
  scatter(energy_, c, Vec6<double>(-force * g.hessian * y), lin_.pose_gradient_[e.level]);
  force_gradient_ += e.normal.dot(y);
}

/// μ_f λ ∂φ/∂q₊ in Φ_{k+1}.
void LinearisationBuilder::add_friction(const Contact& c, const LocalPoint<double>& here,
                                        Linearisation::Eliminated& e) {
  const double force = x_.forces[e.level][e.contact];
  const Friction<double> f = energy_.friction(c, energy_.point(c, x_.p[e.level + 1]), here);
  const Vec6<double> y = gather(energy_, c, x_.multipliers[e.level + 1]);
  e.friction = c.friction * f.gradient.head<6>();
  const Mat6<double> next = c.friction * force * f.hessian.topLeftCorner<6, 6>();
  const Mat6<double> now = c.friction * force * f.hessian.topRightCorner<6, 6>();
  to_jacobian(c, next, e.level + 1);
  to_jacobian_next(c, now + e.friction * e.b.transpose(), e.level);
  scatter(energy_, c, Vec6<double>(next * y), lin_.pose_gradient_[e.level + 1]);
  scatter(energy_, c, Vec6<double>(now.transpose() * y), lin_.pose_gradient_[e.level]);
  force_gradient_ += e.friction.dot(y);
}

/// Second derivatives of y_k·Φ_k through the normal force.
void LinearisationBuilder::add_exact_normal(const Contact& c, Linearisation::Eliminated& e) {
  const double force = x_.forces[e.level][e.contact];
  const Gap<Dual> g = energy_.gap(c, energy_.point(c, x_.p[e.level], x_.multipliers[e.level]));
  to_hessian(c, -force * along<6, 6>(g.hessian), e.level);
  e.now -= along<6, 1>(g.gradient);
}

/// Second derivatives of y_{k+1}·Φ_{k+1} through friction.
void LinearisationBuilder::add_exact_friction(const Contact& c, Linearisation::Eliminated& e) {
  const double force = x_.forces[e.level][e.contact];
  const Friction<Dual> f =
      energy_.friction(c, energy_.point(c, x_.p[e.level + 1], x_.multipliers[e.level + 1]),
                       energy_.point(c, x_.p[e.level], VectorXd::Zero(n_)));
  const Mat12<double> H = c.friction * force * along<12, 12>(f.hessian);
  const Vec12<double> slope = c.friction * along<12, 1>(f.gradient);
  to_hessian(c, H.topLeftCorner<6, 6>(), e.level + 1);
  to_hessian(c, H.bottomRightCorner<6, 6>(), e.level);
  to_coupling(c, H.topRightCorner<6, 6>(), e.level);
  e.next = slope.head<6>();
  e.now += slope.tail<6>();
}

/// Folds the force and the multiplier z of its complementarity into the system.
void LinearisationBuilder::eliminate(const Contact& c, const Gap<double>& g,
                                     Linearisation::Eliminated& e) {
  scatter(energy_, c, Vec6<double>(force_gradient_ * e.b), lin_.pose_gradient_[e.level]);
  const Barrier::Window window = energy_.barrier().window(g.value);
  const double weight = energy_.barrier().weight;
  Mat6<double> H = Mat6<double>::Zero();
  if (curvature_.exact) {
    const double z = -force_gradient_ / g.value;
    const double s = x_.forces[e.level][e.contact] - weight * window.d1;
    H += z * (s * g.hessian - weight * window.d2 * g.gradient * g.gradient.transpose());
    e.now += z * g.gradient;
    H += symmetric_product(e.now, e.b);
    if (e.level < h_) to_coupling(c, e.next * e.b.transpose(), e.level);
  }
  const double proximal = kForceProximal * curvature_.proximal;
  H += proximal * e.b * e.b.transpose();
  e.now += proximal * e.b;
  to_hessian(c, H, e.level);
}

void LinearisationBuilder::add_proximal() {
  for (int k = 0; k <= h_; ++k) {
    if (lin_.has_pose(k)) lin_.K_.A[k].diagonal().head(n_).array() += curvature_.proximal;
    if (k == 0) continue;
    const Linearisation::Place at = lin_.control_place(k), row = lin_.multiplier_place(k);
    for (int m = 0; m < 3; ++m) entry(at, m, at, m) += curvature_.proximal;
    for (int m = 0; m < n_; ++m) entry(row, m, row, m) -= kMultiplierShift;
  }
}

double& LinearisationBuilder::entry(Linearisation::Place row, int i, Linearisation::Place column,
                                    int j) {
  if (row.block < column.block) return entry(column, j, row, i);
  MatrixXd& into = row.block == column.block ? lin_.K_.A[row.block] : lin_.K_.B[row.block];
  return into(row.row + i, column.row + j);
}

void LinearisationBuilder::add(const Contact& c, const Mat6<double>& M, Linearisation::Place row,
                               Linearisation::Place column) {
  if (row.block < column.block) return add(c, M.transpose(), column, row);
  MatrixXd& into = row.block == column.block ? lin_.K_.A[row.block] : lin_.K_.B[row.block];
  scatter(energy_, c, M, into.block(row.row, column.row, n_, n_));
}

void LinearisationBuilder::to_hessian(const Contact& c, const Mat6<double>& M, int level) {
  if (lin_.has_pose(level)) add(c, M, lin_.pose_place(level), lin_.pose_place(level));
}

void LinearisationBuilder::to_coupling(const Contact& c, const Mat6<double>& M, int level) {
  if (lin_.has_pose(level + 1)) add(c, M, lin_.pose_place(level + 1), lin_.pose_place(level));
}

void LinearisationBuilder::to_jacobian(const Contact& c, const Mat6<double>& M, int level) {
  if (lin_.has_pose(level)) add(c, M, lin_.multiplier_place(level), lin_.pose_place(level));
}

void LinearisationBuilder::to_jacobian_next(const Contact& c, const Mat6<double>& M, int level) {
  add(c, M, lin_.multiplier_place(level + 1), lin_.pose_place(level));
}

}  // namespace rtg
