#pragma once

#include <numbers>

#include "tests/support/touching_scene.hpp"

namespace rtg::testing {

/// A chain of links 2.4 m by 0.7 m along x, the first one's centre at the origin, each joined to
/// the next one within ±137°.
inline Scene chain(int links) {
  Scene scene;
  const double limit = 137.0 / 180.0 * std::numbers::pi;
  for (int k = 0; k < links; ++k) {
    scene.bodies.push_back({"link" + std::to_string(k), "link", box(2.4, 0.7), 1.0, 0.5, false});
    if (k > 0) scene.joints.push_back({k - 1, k, {1.2, 0.0}, {-1.2, 0.0}, -limit, limit});
  }
  return scene;
}

/// Gathering's robot and a chain of four links.
inline Scene robot_and_chain() {
  const Scene links = chain(4);
  Scene scene{{gathering().scene.bodies[0]}, {}};
  for (const Body& link : links.bodies) scene.bodies.push_back(link);
  for (Joint joint : links.joints) {
    ++joint.parent;
    ++joint.child;
    scene.joints.push_back(joint);
  }
  return scene;
}

/// Largest distance between two points that a joint pins together [m].
inline double widest_joint(const Scene& scene, const Poses& poses) {
  double gap = 0.0;
  for (const Joint& joint : scene.joints) gap = std::max(gap, joint_gap(joint, poses));
  return gap;
}

/// Gathering's robot in contact with the middle one of three links and with a door hinged to a
/// wall, which is close to its limit.
struct ChainScene : TouchingScene {
  ChainScene() {
    Scene jointed{{scene.bodies[0]}, {}};
    for (const Body& link : chain(3).bodies) jointed.bodies.push_back(link);
    jointed.bodies.push_back({"door", "door", box(1.5, 0.3), 1.0, 0.5, false});
    jointed.bodies.push_back({"wall", "wall", box(1.0, 1.0), 1.0, 0.5, true});
    // Not in the order of the bodies: the middle link is the root.
    jointed.joints = {{2, 3, {1.2, 0.0}, {-1.2, 0.0}, -2.4, 2.4},
                      {5, 4, {0.0, -0.7}, {0.75, 0.0}, -0.1, 1.5},
                      {2, 1, {-1.2, 0.0}, {1.2, 0.0}, -1.2, 1.2}};
    scene = jointed;
    poses = with_closed_joints(scene, {{0.0, 0.0, 0.0},
                                       {0, 0, 0.82},
                                       {1.0, 0.5, 2.0},
                                       {0, 0, 1.2},
                                       {0, 0, 1.45},
                                       {1.92, 4.6, 0.0}});
    update();
  }
};

/// Stacked poses moved onto the joints.
inline VectorXd closed(const energy::StepEnergy& energy, const VectorXd& p) {
  energy::Placement<double> at = energy::placed(p);
  energy.scene().place(at);
  return Eigen::Map<const VectorXd>(at.p.data(), p.size());
}

/// J y of a motion of the coordinates at p.
inline VectorXd apply_jacobian(const energy::StepEnergy& energy, const VectorXd& p, VectorXd y) {
  energy.scene().articulation().apply_jacobian(energy::placed(p), y.data());
  return y;
}

/// `y` without the entries that belong to no coordinate.
inline VectorXd of_coordinates(const energy::StepEnergy& energy, VectorXd y) {
  for (const energy::Hinge<double>& hinge : energy.scene().articulation().hinges())
    y.segment<2>(3 * hinge.child).setZero();
  return y;
}

}  // namespace rtg::testing
