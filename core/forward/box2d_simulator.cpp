#include "core/forward/box2d_simulator.hpp"

#include <box2d/box2d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "core/forward/free_path.hpp"
#include "core/math/elementary.hpp"

namespace rtg::forward {
namespace {

// Largest coordinate [m] and angle [rad] of a start. At these values the spacing of
// single-precision numbers is still well below Box2D's linear and angular slop.
constexpr double kMaxCoordinate = 1000.0;
constexpr double kMaxAngle = 1e4;
constexpr double kCatchUp = 1.5;  // largest servo speed / push speed
constexpr int kCatchUpSteps = 2;  // extra steps after the path, because contacts delay the robot
constexpr double kClear = 0.1;    // bodies farther apart cannot touch within the next steps [m]
constexpr int kRestSteps = 400;
constexpr double kRestSpeed = 1e-4;  // speed of a body at rest [m/s] and [rad/s]
constexpr double kSlowSpeed = 1e-2;  // speed that is accepted after the last step, same units
// Largest displacement of a body per step once Box2D has moved overlapping bodies apart [m], [rad].
constexpr double kRestShift = 1e-5;

b2Vec2 to_b2(const Vector2d& v) { return {static_cast<float>(v.x()), static_cast<float>(v.y())}; }

Pose pose_of(const b2Body& body) {
  return {body.GetPosition().x, body.GetPosition().y, body.GetAngle()};
}

/// Quantities of the servo that are constant over a push.
struct Servo {
  double step_s = 0.0;   // length of a Box2D step [s]
  double advance = 0.0;  // motion of the robot per Box2D step [m]
  double radius = 0.0;   // r₀ [m]
  double max_force = 0.0, max_torque = 0.0;
  int rest_steps = 0;  // largest number of steps of come_to_rest()
};

// Box2D damps an applied force within its step, but not the impulse of a joint. For the same motion
// a joint therefore needs only 1/(1 + h d) of the force, with the step h and the damping d. The
// bounds are scaled by this factor: the servo then stops the robot where it would stop in Ψ.
Servo servo_of(const Scene& scene, double stride, const PhysicsConfig& physics) {
  const double damping = physics.damping / physics.time_step;
  const double speed = stride / (physics.sub_steps * physics.time_step);
  const double step_s = physics.time_step / physics.box2d_steps;
  const double radius = scene.bodies[0].shape.radius();
  const double drag = mass_of(scene.bodies[0]).mass * damping * speed *
                      (1.0 + physics.inertia_weight()) / (1.0 + step_s * damping);
  // Each step divides the speed of a free body by 1 + h d.
  const double coasting =
      logarithm(kCatchUp * speed / kRestSpeed) / logarithm(1.0 + step_s * damping);
  return {step_s,
          speed * step_s,
          radius,
          physics.force_factor * drag,
          physics.torque_factor * drag * radius,
          kRestSteps + static_cast<int>(std::clamp(coasting, 0.0, 1e6))};
}

/// Returns whether the bounding circle of body `i` is at least kClear away from all others.
bool is_isolated(const Scene& scene, const Poses& poses, std::size_t i) {
  const double radius = scene.bodies[i].shape.radius() + kClear;
  for (std::size_t j = 0; j < scene.size(); ++j)
    if (j != i && (poses[j].position() - poses[i].position()).norm() <
                      radius + scene.bodies[j].shape.radius())
      return false;
  return true;
}

/// A Box2D world that holds one scene.
class World {
 public:
  World(const Scene& scene, const PhysicsConfig& physics, const Servo& servo, const Poses& start)
      : physics_(physics), servo_(servo), last_finite_poses_(start), touched_(start.size(), false) {
    world_.SetAllowSleeping(false);
    world_.SetContinuousPhysics(false);  // a Box2D step moves bodies by far less than their size
    for (std::size_t i = 0; i < scene.size(); ++i) {
      // An isolated body sleeps until another body hits it, which saves the cost of its island.
      add(scene.bodies[i], start[i], i == 0 || !is_isolated(scene, start, i));
    }
    touched_[0] = true;
    add_servo();
    for (const Joint& joint : scene.joints) add_joint(joint);
  }

  /// Makes a Box2D step in which the servo moves the robot towards `target`. Returns false if a
  /// pose is not finite afterwards; poses() then remain those before the step.
  bool step_towards(const Pose& target) {
    const Pose robot = pose_of(*bodies_[0]);
    const double reach = kCatchUp * servo_.advance;
    Vector2d ahead = target.position() - robot.position();
    if (ahead.norm() > reach) ahead *= reach / ahead.norm();
    const double turn =
        std::clamp(target.theta - robot.theta, -reach / servo_.radius, reach / servo_.radius);
    servo_joint_->SetLinearOffset(to_b2(robot.position() + ahead));
    servo_joint_->SetAngularOffset(static_cast<float>(robot.theta + turn));
    world_.Step(static_cast<float>(servo_.step_s), physics_.box2d_velocity_iterations,
                physics_.box2d_position_iterations);
    return observe();
  }

  /// Makes steps with the robot held at its pose until all bodies are at rest. Returns false if a
  /// pose is not finite or a body still moves after the last step.
  bool come_to_rest() {
    const Pose hold = pose_of(*bodies_[0]);
    for (int k = 0; k < servo_.rest_steps; ++k) {
      if (!step_towards(hold)) return false;
      if (fastest_ < kRestSpeed && shift_ < kRestShift) return true;
    }
    return fastest_ < kSlowSpeed;
  }

  /// Marks every body as touched. poses() then include the motion by which Box2D resolves overlaps
  /// of the start; otherwise bodies without velocity keep their start.
  void touch_all() { touched_.assign(touched_.size(), true); }

  const Poses& poses() const { return last_finite_poses_; }

 private:
  void add(const Body& body, const Pose& pose, bool awake) {
    b2BodyDef def;
    def.type = body.fixed ? b2_staticBody : b2_dynamicBody;
    def.awake = awake;
    def.position = to_b2(pose.position());
    def.angle = static_cast<float>(pose.theta);
    def.linearDamping = def.angularDamping =
        static_cast<float>(physics_.damping / physics_.time_step);
    b2Body* const added = world_.CreateBody(&def);
    for (const Part& part : body.shape.parts())
      add_fixtures(*added, part, static_cast<float>(body.friction));
    if (!body.fixed) {
      // Box2D stores the position of the centre of mass, not of the body origin. A centre of
      // exactly zero avoids rounding of poses.
      const Mass mass = mass_of(body);
      const b2MassData data{
          static_cast<float>(mass.mass), {0.0f, 0.0f}, static_cast<float>(mass.moment)};
      added->SetMassData(&data);
    }
    bodies_.push_back(added);
  }

  /// Adds the fixtures whose union is `part`. Box2D keeps polygons, but not circles, apart by a
  /// skin of b2_polygonRadius each; a circle is larger by that.
  static void add_fixtures(b2Body& to, const Part& part, float friction) {
    b2FixtureDef fixture;
    fixture.friction = friction;
    const auto add_polygon = [&](std::span<const Vector2d> vertices) {
      std::array<b2Vec2, kMaxVertices> corners;
      std::ranges::transform(vertices, corners.begin(), to_b2);
      b2PolygonShape shape;
      shape.Set(corners.data(), static_cast<int>(vertices.size()));
      fixture.shape = &shape;
      to.CreateFixture(&fixture);
    };
    const std::vector<Vector2d>& core = part.core.vertices;
    if (!part.is_disc()) add_polygon(core);
    if (part.radius == 0.0) return;
    for (std::size_t k = 0; k < core.size(); ++k) {
      b2CircleShape corner;
      corner.m_p = to_b2(core[k]);
      corner.m_radius = static_cast<float>(part.radius) + b2_polygonRadius;
      fixture.shape = &corner;
      to.CreateFixture(&fixture);
      if (part.is_disc()) return;
      const Vector2d &v = core[k], &w = core[(k + 1) % core.size()];
      const Vector2d edge = (w - v).normalized();
      const Vector2d out = part.radius * Vector2d(edge.y(), -edge.x());
      add_polygon(std::array{v, Vector2d(v + out), Vector2d(w + out), w});
    }
  }

  void add_joint(const Joint& joint) {
    switch (joint.type) {
      case JointType::kRevolute: {
        b2RevoluteJointDef def;
        set_ends(def, joint);
        def.enableLimit = is_limited(joint);
        std::tie(def.lowerAngle, def.upperAngle) = limits_of(joint, b2_angularSlop, kMaxAngle);
        world_.CreateJoint(&def);
        return;
      }
      case JointType::kPrismatic: {
        b2PrismaticJointDef def;
        set_ends(def, joint);
        def.localAxisA = to_b2(joint.axis);
        def.referenceAngle = static_cast<float>(joint.angle);
        def.enableLimit = is_limited(joint);
        std::tie(def.lowerTranslation, def.upperTranslation) =
            limits_of(joint, b2_linearSlop, kMaxCoordinate);
        world_.CreateJoint(&def);
        return;
      }
      case JointType::kFixed: {
        b2WeldJointDef def;
        set_ends(def, joint);
        def.referenceAngle = static_cast<float>(joint.angle);
        world_.CreateJoint(&def);
        return;
      }
    }
  }

  template <class Def>
  void set_ends(Def& def, const Joint& joint) const {
    def.bodyA = bodies_[static_cast<std::size_t>(joint.parent)];
    def.bodyB = bodies_[static_cast<std::size_t>(joint.child)];
    def.localAnchorA = to_b2(joint.on_parent);
    def.localAnchorB = to_b2(joint.on_child);
  }

  static bool is_limited(const Joint& joint) {
    return std::isfinite(joint.lower) || std::isfinite(joint.upper);
  }

  /// Returns the limits for Box2D, which lets a loaded joint exceed them by its `slop`.
  static std::pair<float, float> limits_of(const Joint& joint, double slop, double most) {
    slop = std::min(slop, 0.5 * (joint.upper - joint.lower));
    return {static_cast<float>(std::max(joint.lower + slop, -most)),
            static_cast<float>(std::min(joint.upper - slop, most))};
  }

  void add_servo() {
    const b2BodyDef ground;
    b2MotorJointDef def;
    def.bodyA = world_.CreateBody(&ground);
    def.bodyB = bodies_[0];
    def.maxForce = static_cast<float>(servo_.max_force);
    def.maxTorque = static_cast<float>(servo_.max_torque);
    def.correctionFactor = 1.0f;
    def.collideConnected = true;
    servo_joint_ = static_cast<b2MotorJoint*>(world_.CreateJoint(&def));
  }

  /// Updates last_finite_poses_, touched_, fastest_ and shift_ after a step. Returns false, without
  /// an update, if a pose is not finite.
  bool observe() {
    for (const b2Body* body : bodies_)
      if (!is_finite(pose_of(*body))) return false;
    fastest_ = shift_ = 0.0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const double speed = bodies_[i]->GetLinearVelocity().Length();
      const double spin = std::abs(bodies_[i]->GetAngularVelocity());
      // Contacts at rest exchange exactly zero impulse. A body that moves at zero speed is
      // therefore moved by Box2D's position correction only.
      if (speed > 0.0 || spin > 0.0) touched_[i] = true;
      if (!touched_[i]) continue;
      const Pose now = pose_of(*bodies_[i]);
      fastest_ = std::max({fastest_, speed, spin});
      shift_ = std::max({shift_, (now.position() - last_finite_poses_[i].position()).norm(),
                         std::abs(now.theta - last_finite_poses_[i].theta)});
      last_finite_poses_[i] = now;
    }
    return true;
  }

  const PhysicsConfig& physics_;
  const Servo& servo_;
  b2World world_{b2Vec2(0.0f, 0.0f)};
  std::vector<b2Body*> bodies_;
  b2MotorJoint* servo_joint_ = nullptr;
  Poses last_finite_poses_;    // initially the start
  std::vector<bool> touched_;  // per body: whether it has had a velocity
  double fastest_ = 0.0;       // largest speed of a touched body [m/s] or [rad/s]
  double shift_ = 0.0;         // largest displacement in the last step [m] or [rad]
};

/// The robot's straight path, divided into steps at push speed.
struct Path {
  Pose from, to;
  double advance;  // motion per step [m]
  int steps;

  Path(const Pose& start, const Pose& end, double per_step, int most)
      : from(start),
        to(end),
        advance(per_step),
        steps(std::min(most, static_cast<int>(std::ceil(length() / advance - 1e-6)))) {}

  double length() const { return (to.position() - from.position()).norm(); }
  /// Returns the robot's pose after k steps.
  Pose at(int k) const {
    const double done = std::min(1.0, k * advance / std::max(length(), advance));
    const Vector2d x = from.position() + done * (to.position() - from.position());
    return {x.x(), x.y(), from.theta};
  }
};

/// Drives the robot along its path, of which the first `done` steps are already made. Returns false
/// if a pose was not finite.
bool drive(World& table, const Path& path, int done) {
  for (int k = done + 1; k <= path.steps + kCatchUpSteps; ++k)
    if (!table.step_towards(path.at(k))) return false;
  return true;
}

}  // namespace

std::string Box2dSimulator::library_version() {
  return std::to_string(b2_version.major) + "." + std::to_string(b2_version.minor) + "." +
         std::to_string(b2_version.revision);
}

Box2dSimulator::Box2dSimulator(Scene scene, PushConfig push, PhysicsConfig physics)
    : Simulator(std::move(push)), scene_(std::move(scene)), physics_(physics) {}

bool Box2dSimulator::plausible(const Poses& start) const {
  if (start.size() != scene_.size()) return false;
  return std::all_of(start.begin(), start.end(), [](const Pose& p) {
    return is_finite(p) && std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate &&
           std::abs(p.theta) <= kMaxAngle;
  });
}

PushOutcome Box2dSimulator::push_along(const Poses& start, const Stroke& stroke) const {
  if (!plausible(start)) return {start, false};
  const Servo servo = servo_of(scene_, stroke.length, physics_);
  const Path path(start[0], push_target(start[0], stroke, push_), servo.advance,
                  physics_.sub_steps * physics_.box2d_steps);
  const double clear = free_path_length(scene_, start, path.to);
  Poses begun = start;
  if (clear >= path.length()) {  // no body is near the path
    begun[0] = to_single(path.to);
    return {begun, true};
  }
  const int done = std::min(path.steps, static_cast<int>(clear / servo.advance));
  begun[0] = path.at(done);
  World table(scene_, physics_, servo, begun);
  const bool ok = drive(table, path, done) && table.come_to_rest();
  return {table.poses(), ok};
}

PushOutcome Box2dSimulator::settle(const Poses& start) const {
  if (!plausible(start)) return {start, false};
  const Servo servo = servo_of(scene_, longest_stride(push_), physics_);
  World table(scene_, physics_, servo, start);
  table.touch_all();
  const bool ok = table.come_to_rest();
  return {table.poses(), ok};
}

}  // namespace rtg::forward
