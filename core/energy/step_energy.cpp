#include "core/energy/step_energy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace rtg {
namespace {

constexpr double kCorners = 4.0;  // allowed overlap, in units of ln 2/α

Pose pose_of(const VectorXd& p, int body) {
  return {p[3 * body], p[3 * body + 1], p[3 * body + 2]};
}

template <class S>
Vec6<S> pair_pose(const Contact& c, const Eigen::Matrix<S, Eigen::Dynamic, 1>& p) {
  Vec6<S> q;
  q << p.template segment<3>(3 * c.body), p.template segment<3>(3 * c.other);
  return q;
}

}  // namespace

StepEnergy::StepEnergy(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push)
    : sharpness_(physics.sharpness), skin_(physics.skin), slip_(physics.slip) {
  const double unit = physics.damping / (physics.time_step * physics.time_step);  // k_D/Δt²
  barrier_ = {physics.barrier / unit, physics.range, physics.plain_barrier};
  stride_ = push.stride / physics.sub_steps;
  for (const Body& body : scene.bodies) {
    assert(body.fixed || movable_ == static_cast<int>(shapes_.size()));
    if (!body.fixed) ++movable_;
    const Mass mass = mass_of(body);
    shapes_.push_back(body.shape);
    planes_.push_back(half_planes(body.shape));
    radius_.push_back(bounding_radius(body.shape));
    damping_.push_back({mass.mass, mass.moment, physics.periodic_damping});
  }
  const double drag = damping_[0].mass * stride_;  // of the robot at push speed
  control_bound_ << Vector2d::Constant(physics.force_factor * drag),
      physics.torque_factor * drag * radius_[0];
  for (int i = 0; i < bodies(); ++i)
    for (int j = i + 1; j < bodies(); ++j)
      if (movable(i) || movable(j)) {
        add_pair_contacts(scene, i, j);
        add_pair_contacts(scene, j, i);
      }
}

void StepEnergy::add_pair_contacts(const Scene& scene, int body, int other) {
  const double friction = pair_friction(scene.bodies[body], scene.bodies[other]);
  for (const Vector2d& v : shapes_[body].vertices) contacts_.push_back({body, other, v, friction});
}

bool StepEnergy::near(const Contact& c, const VectorXd& p) const {
  if (barrier_.plain) return true;
  const double reach = radius_[c.body] + radius_[c.other] + barrier_.range + skin_;
  return (p.segment<2>(3 * c.body) - p.segment<2>(3 * c.other)).squaredNorm() < reach * reach;
}

LocalPoint<double> StepEnergy::point(const Contact& c, const VectorXd& p) const {
  return {c.vertex, pair_pose<double>(c, p)};
}

LocalPoint<Dual> StepEnergy::point(const Contact& c, const VectorXd& p, const VectorXd& y) const {
  const Vec6<double> q = pair_pose<double>(c, p), along = gather(*this, c, y);
  Vec6<Dual> dual;
  for (int m = 0; m < 6; ++m) dual[m] = Dual(q[m], along[m]);
  return {c.vertex, dual};
}

double StepEnergy::gap_value(const Contact& c, const LocalPoint<double>& point) const {
  const double bound = mitred_distance(planes_[c.other], point.x) - skin_;
  if (bound > barrier_.range && !barrier_.plain) return bound;
  return rtg::gap_value(planes_[c.other], sharpness_, skin_, point);
}

VectorXd StepEnergy::forces(const VectorXd& p) const {
  VectorXd lambda = VectorXd::Zero(static_cast<Eigen::Index>(contacts_.size()));
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!near(contacts_[k], p)) continue;
    const double g = gap_value(contacts_[k], p);
    if (barrier_.acts(g)) lambda[static_cast<Eigen::Index>(k)] = barrier_.force(g);
  }
  return lambda;
}

double StepEnergy::value(const VectorXd& next, const VectorXd& now, const VectorXd& lag) const {
  double sum = 0.0;
  for (int i = 0; i < movable_; ++i) {
    const Vector3d moved = next.segment<3>(3 * i) - now.segment<3>(3 * i);
    sum +=
        0.5 * damping_[i].mass * moved.head<2>().squaredNorm() + damping_[i].turn_value(moved[2]);
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Contact& c = contacts_[k];
    const double force = lag[static_cast<Eigen::Index>(k)];
    if (near(c, next)) sum += barrier_.value(gap_value(c, next));
    if (force != 0.0) sum += c.friction * force * slip(c, point(c, next), point(c, now)).value;
  }
  return sum;
}

StepEnergy::Model StepEnergy::model(const VectorXd& next, const VectorXd& now,
                                    const VectorXd& lag) const {
  Model model{VectorXd::Zero(dofs()), MatrixXd::Zero(dofs(), dofs())};
  for (int i = 0; i < movable_; ++i) {
    const Vector3d moved = next.segment<3>(3 * i) - now.segment<3>(3 * i);
    const Damping& body = damping_[i];
    model.gradient.segment<3>(3 * i) << body.mass * moved.head<2>(), body.turn_slope(moved[2]);
    model.hessian.diagonal().segment<3>(3 * i) << Vector2d::Constant(body.mass),
        body.turn_curvature(moved[2]);
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    add_contact(contacts_[k], next, now, lag[static_cast<Eigen::Index>(k)], model);
  return model;
}

void StepEnergy::add_contact(const Contact& c, const VectorXd& next, const VectorXd& now,
                             double lag, Model& model) const {
  const bool close = near(c, next);
  if (!close && lag == 0.0) return;
  const LocalPoint<double> ahead = point(c, next);
  if (close && barrier_.acts(gap_value(c, ahead))) {
    const Gap<double> g = gap(c, ahead);
    const double force = barrier_.force(g.value), slope = barrier_.force_slope(g.value);
    scatter(*this, c, Vec6<double>(-force * g.gradient), model.gradient);
    scatter(*this, c,
            Mat6<double>(-slope * g.gradient * g.gradient.transpose() - force * g.hessian),
            model.hessian);
  }
  if (lag == 0.0) return;
  const Slip<double> s = slip(c, ahead, point(c, now));
  scatter(*this, c, Vec6<double>(c.friction * lag * s.gradient()), model.gradient);
  scatter(*this, c, Mat6<double>(c.friction * lag * s.hessian()), model.hessian);
}

/// Whether an edge normal of i separates it from j; corners may overlap by `cut`.
bool StepEnergy::has_separating_edge(int i, int j, const VectorXd& p, double cut) const {
  const Pose in = pose_of(p, i), of = pose_of(p, j);
  Vector2d vertices[kMaxVertices];
  for (std::size_t m = 0; m < shapes_[j].size(); ++m)
    vertices[m] = to_local(in, to_world(of, shapes_[j].vertices[m]));
  for (int k = 0; k < planes_[i].count; ++k) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < shapes_[j].size(); ++m)
      least = std::min(least, planes_[i].normal[k].dot(vertices[m]));
    if (least - planes_[i].offset[k] > -cut) return true;
  }
  return false;
}

bool StepEnergy::separated(const VectorXd& p) const {
  const double cut = kCorners * std::numbers::ln2 / sharpness_;
  for (int i = 0; i < movable_; ++i)
    for (int j = i + 1; j < bodies(); ++j) {
      const double reach = radius_[i] + radius_[j];
      if ((p.segment<2>(3 * i) - p.segment<2>(3 * j)).squaredNorm() > reach * reach) continue;
      if (!has_separating_edge(i, j, p, cut) && !has_separating_edge(j, i, p, cut)) return false;
    }
  return true;
}

bool StepEnergy::keeps_gaps(const VectorXd& before, const VectorXd& after, double share) const {
  for (const Contact& c : contacts_) {
    if (!near(c, after)) continue;
    const double g = gap_value(c, after);
    if (!(g > 0.0)) return false;
    if (g < share * barrier_.range && g < share * gap_value(c, before)) return false;
  }
  return separated(after);
}

void scatter(const StepEnergy& energy, const Contact& c, const Mat6<double>& M,
             Eigen::Ref<MatrixXd> into) {
  const int at[2] = {3 * c.body, 3 * c.other};
  const bool moves[2] = {energy.movable(c.body), energy.movable(c.other)};
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      if (moves[a] && moves[b]) into.block<3, 3>(at[a], at[b]) += M.block<3, 3>(3 * a, 3 * b);
}

void scatter(const StepEnergy& energy, const Contact& c, const Vec6<double>& v,
             Eigen::Ref<VectorXd> into) {
  if (energy.movable(c.body)) into.segment<3>(3 * c.body) += v.head<3>();
  if (energy.movable(c.other)) into.segment<3>(3 * c.other) += v.tail<3>();
}

Vec6<double> gather(const StepEnergy& energy, const Contact& c, const VectorXd& v) {
  Vec6<double> both = Vec6<double>::Zero();
  if (energy.movable(c.body)) both.head<3>() = v.segment<3>(3 * c.body);
  if (energy.movable(c.other)) both.tail<3>() = v.segment<3>(3 * c.other);
  return both;
}

VectorXd stacked(const Poses& poses) {
  VectorXd p(3 * static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
    p.segment<3>(3 * static_cast<Eigen::Index>(i)) << poses[i].x, poses[i].y, poses[i].theta;
  return p;
}

Poses unstacked(const VectorXd& p) {
  Poses poses(static_cast<std::size_t>(p.size() / 3));
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = pose_of(p, static_cast<int>(i));
  return poses;
}

}  // namespace rtg
