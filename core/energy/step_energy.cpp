#include "core/energy/step_energy.hpp"

#include "core/energy/joint_limit.hpp"
#include "core/energy/step_potential.hpp"

namespace rtg::energy {
StepEnergy::StepEnergy(const Scene& scene, const PhysicsConfig& physics, const PushConfig& push)
    : scene_(scene, physics, push) {
  for (int n = 0; n < scene_.pair_count(); ++n)
    for (int v = 0; v < scene_.corners(n) && scene_.is_tip(n, v); ++v)
      contacts_.push_back(
          {scene_.pairs()[n].body, scene_.pairs()[n].other, scene_.friction(n), n, v});
  constexpr int kPerPair = static_cast<int>(kMaxVertices);
  int limit = 0;
  for (const JointModel<double>& joint : scene_.articulation().joints())
    for (int side = 0; side < 2; ++side, ++limit)
      contacts_.push_back({joint.child, joint.parent, 0.0, scene_.pair_count() + limit / kPerPair,
                           limit % kPerPair});
}

double StepEnergy::gap_value(const Contact& c, const VectorXd& p) const {
  const Placement<double> at = placed(p);
  if (is_limit(c)) {
    double gap = 0.0;
    for_each_limit(scene_.articulation(), at, [&](int l, const JointLimit<double>& limit) {
      if (scene_.limit_contact(l) == contact_of(c.pair, c.vertex)) gap = limit.gap;
    });
    return gap;
  }
  return VertexContact<double>(scene_, c.pair, c.vertex, scene_.frame(c.pair, at),
                               scene_.near(c.pair, at))
      .gap();
}

ContactSite StepEnergy::site(const Contact& c, const VectorXd& p) const {
  const Placement<double> at = placed(p);
  const VertexContact<double> contact(scene_, c.pair, c.vertex, scene_.frame(c.pair, at), true);
  const Vector2d gradient = contact.distance().gradient;
  const Pose other{p[3 * c.other], p[3 * c.other + 1], p[3 * c.other + 2]};
  const Vector2d normal = rotate(other.theta, gradient.normalized());
  return {to_world(other, contact.point.x) - contact.point.radius * normal, normal};
}

VectorXd StepEnergy::forces(const VectorXd& p, double spare) const {
  std::vector<double> lambda(static_cast<std::size_t>(scene_.contacts()));
  scene_.forces(placed(p), lambda.data(), spare);
  return from_contact_index(lambda);
}

namespace {

/// A StepPotential after begin(), together with the placements that must outlive it.
struct Begun {
  Placement<double> now, before;
  StepPotential<double> potential;

  Begun(const StepEnergy& energy, const StepFrom& from)
      : now(placed(from.now)),
        before(from.before ? placed(*from.before) : Placement<double>()),
        potential(energy.scene()) {
    potential.begin(now, energy.to_contact_index(from.previous_forces).data(),
                    from.before ? &before : nullptr);
  }
};

}  // namespace

double StepEnergy::value(const VectorXd& next, const StepFrom& from) const {
  const Begun begun(*this, from);
  std::vector<double> gaps(static_cast<std::size_t>(scene_.contacts()), 0.0);
  bool legal;
  return begun.potential.value(placed(next), gaps.data(), gaps.data(), legal);
}

StepEnergy::Model StepEnergy::model(const VectorXd& next, const StepFrom& from) const {
  Model model{VectorXd::Zero(dofs()), MatrixXd::Zero(dofs(), dofs())};
  BlockMatrix<double> H(scene_.movable());
  const Begun begun(*this, from);
  begun.potential.model(placed(next), model.gradient.data(), H);
  begun.potential.reduce(placed(next), model.gradient.data(), H);
  for (int i = 0; i < H.M; ++i)
    for (int j = 0; j <= i; ++j) {
      if (!H.has(i, j)) continue;
      model.hessian.block<3, 3>(3 * i, 3 * j) = H.at(i, j);
      model.hessian.block<3, 3>(3 * j, 3 * i) = H.at(i, j).transpose();
    }
  return model;
}

bool StepEnergy::separated(const VectorXd& p) const { return scene_.separated(placed(p)); }

std::vector<double> StepEnergy::to_contact_index(const VectorXd& per_contact) const {
  std::vector<double> out(static_cast<std::size_t>(scene_.contacts()), 0.0);
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    out[static_cast<std::size_t>(contact_of(contacts_[k].pair, contacts_[k].vertex))] =
        per_contact[static_cast<Eigen::Index>(k)];
  return out;
}

VectorXd StepEnergy::from_contact_index(const std::vector<double>& by_index) const {
  VectorXd out(static_cast<Eigen::Index>(contacts_.size()));
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    out[static_cast<Eigen::Index>(k)] =
        by_index[static_cast<std::size_t>(contact_of(contacts_[k].pair, contacts_[k].vertex))];
  return out;
}

Placement<double> placed(const VectorXd& p) {
  Placement<double> out(static_cast<int>(p.size() / 3));
  out.p.assign(p.begin(), p.end());
  out.update();
  return out;
}

VectorXd stacked(const Poses& poses) {
  VectorXd p(3 * static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
    p.segment<3>(3 * static_cast<Eigen::Index>(i)) << poses[i].x, poses[i].y, poses[i].theta;
  return p;
}

Poses unstacked(const VectorXd& p) {
  Poses poses(static_cast<std::size_t>(p.size() / 3));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    poses[i] = {p[at], p[at + 1], p[at + 2]};
  }
  return poses;
}

}  // namespace rtg::energy
