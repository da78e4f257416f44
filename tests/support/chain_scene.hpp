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

/// Gathering's robot in contact with a carriage, on which a slider runs that carries a plate, to
/// which an arm is pinned; and a drawer in a wall. Slider and drawer are close to a limit.
struct SliderScene : TouchingScene {
  SliderScene() {
    const auto add = [this](const char* name, const Shape& shape, bool fixed = false) {
      scene.bodies.push_back({name, name, shape, 1.0, 0.5, fixed});
    };
    scene = {{scene.bodies[0]}, {}};
    add("carriage", box(1.2, 1.2));
    add("slider", box(1.0, 0.4));
    add("plate", box(0.6, 0.6));
    add("arm", box(1.2, 0.3));
    add("drawer", box(1.5, 0.8));
    add("wall", box(1.0, 1.0), true);
    Joint slides{1, 2, {0.3, 0.1}, {-0.1, 0.05}, -0.5, 1.33, JointType::kPrismatic};
    slides.axis = Vector2d(0.9, 0.4).normalized();
    slides.angle = 0.4;
    Joint fixed{2, 3, {0.9, 0.1}, {0.0, 0.0}};
    fixed.type = JointType::kFixed;
    fixed.angle = 0.7;
    Joint drawer{6, 5, {0.0, -0.6}, {0.75, 0.0}, -0.01, 2.0, JointType::kPrismatic};
    drawer.axis = {0.0, -1.0};
    drawer.angle = 1.57;
    scene.joints = {{3, 4, {0.35, 0.0}, {-0.7, 0.1}, -1.0, 2.0}, drawer, fixed, slides};
    poses = {{0, 0, 0},   {1.46, 0.15, 0.05}, {0, 0, 0},       {0, 0, 0},
             {0, 0, 1.9}, {0, 0, 0},          {1.92, 6.6, 0.0}};
    for (const std::size_t k : root_first(scene))
      set_joint_value(scene.joints[k], k == 0 ? 0.8 : k == 3 ? 1.3 : 0.0, poses);
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

/// The coordinates y of w = J y.
inline VectorXd to_coordinates(const energy::StepEnergy& energy, const VectorXd& p, VectorXd w) {
  energy.scene().articulation().to_coordinates(energy::placed(p), w.data());
  return w;
}

/// Poses p moved by the step d of the coordinates [3·movable].
inline VectorXd advanced(const energy::StepEnergy& energy, const VectorXd& p, const VectorXd& d) {
  energy::Placement<double> to = energy::placed(p);
  energy.scene().advance(energy::placed(p), d.data(), 1.0, to);
  return Eigen::Map<const VectorXd>(to.p.data(), p.size());
}

/// `y` without the entries that belong to no coordinate.
inline VectorXd of_coordinates(const energy::StepEnergy& energy, VectorXd y) {
  for (const energy::JointModel<double>& joint : energy.scene().articulation().joints())
    for (int m = 0; m < 3; ++m)
      if (m != energy::slot_of(joint.type)) y[3 * joint.child + m] = 0.0;
  return y;
}

}  // namespace rtg::testing
