#include "core/energy/articulation.hpp"

#include <gtest/gtest.h>

#include "tests/support/chain_scene.hpp"
#include "tests/support/differences.hpp"

namespace rtg::energy {
namespace {

using testing::advanced;
using testing::apply_jacobian;
using testing::ChainScene;
using testing::closed;
using testing::noise;
using testing::of_coordinates;
using testing::SliderScene;

template <class Scene>
class ArticulationTest : public ::testing::Test {};
using Scenes = ::testing::Types<ChainScene, SliderScene>;
TYPED_TEST_SUITE(ArticulationTest, Scenes);

/// Poses moved at random, jointed bodies off their joints.
VectorXd scattered(const testing::TouchingScene& scene, std::uint64_t seed) {
  Rng rng(seed);
  VectorXd p = stacked(scene.poses);
  p.head(scene.energy.dofs()) += noise(scene.energy.dofs(), 0.5, rng);
  return p;
}

TEST(Articulation, PlacingClosesEveryJointAndKeepsRootsAndAngles) {
  const ChainScene scene;
  const VectorXd p = scattered(scene, 1), after = closed(scene.energy, p);
  for (const Joint& joint : scene.scene.joints)
    EXPECT_LT(joint_gap(joint, unstacked(after)), 1e-15);
  EXPECT_GT(joint_gap(scene.scene.joints[0], unstacked(p)), 0.1);
  for (const int root : {0, 2, 5}) EXPECT_EQ(after.segment<3>(3 * root), p.segment<3>(3 * root));
  for (const int body : {1, 3, 4}) EXPECT_EQ(after[3 * body + 2], p[3 * body + 2]);
  const VectorXd other = stacked(with_closed_joints(scene.scene, unstacked(p)));
  EXPECT_LT((other - after).norm(), 1e-15);
}

TYPED_TEST(ArticulationTest, PlacingClosesEveryJoint) {
  const TypeParam scene;
  const VectorXd p = scattered(scene, 1), after = closed(scene.energy, p);
  for (const Joint& joint : scene.scene.joints)
    EXPECT_LT(joint_gap(joint, unstacked(after)), 1e-15);
  const VectorXd other = stacked(with_closed_joints(scene.scene, unstacked(p)));
  EXPECT_LT((other - after).norm(), 1e-14);
}

TYPED_TEST(ArticulationTest, AStepMovesEachJointByItsCoordinate) {
  const TypeParam scene;
  const VectorXd p = closed(scene.energy, scattered(scene, 1));
  Rng rng(6);
  const VectorXd d = of_coordinates(scene.energy, noise(scene.energy.dofs(), 0.5, rng));
  const Poses before = unstacked(p), after = unstacked(advanced(scene.energy, p, d));
  for (const Joint& joint : scene.scene.joints) {
    EXPECT_LT(joint_gap(joint, after), 1e-15);
    const double moved = joint_value(joint, after) - joint_value(joint, before);
    if (joint.type == JointType::kPrismatic) {
      EXPECT_NEAR(moved, d[3 * joint.child], 1e-14);
    }
    if (joint.type != JointType::kRevolute) continue;
    EXPECT_NEAR(after[static_cast<std::size_t>(joint.child)].theta,
                before[static_cast<std::size_t>(joint.child)].theta + d[3 * joint.child + 2],
                1e-14);
  }
}

TYPED_TEST(ArticulationTest, JacobianIsTheDerivativeOfThePoses) {
  const TypeParam scene;
  const int n = scene.energy.dofs();
  const VectorXd p = closed(scene.energy, scattered(scene, 2));
  Rng rng(3);
  for (int trial = 0; trial < 5; ++trial) {
    const VectorXd y = of_coordinates(scene.energy, noise(n, 1.0, rng));
    const double t = 1e-6;
    const VectorXd slope =
        (advanced(scene.energy, p, t * y) - advanced(scene.energy, p, -t * y)) / (2.0 * t);
    const VectorXd w = apply_jacobian(scene.energy, p, y);
    EXPECT_LT((slope.head(n) - w).norm(), 1e-8);
    EXPECT_LT((testing::to_coordinates(scene.energy, p, w) - y).norm(), 1e-14);
  }
}

TYPED_TEST(ArticulationTest, TransposedJacobianIsTheTranspose) {
  const TypeParam scene;
  const int n = scene.energy.dofs();
  const VectorXd p = closed(scene.energy, scattered(scene, 4));
  Rng rng(5);
  const VectorXd force = noise(n, 1.0, rng);
  VectorXd reduced = force;
  scene.energy.scene().articulation().apply_jacobian_transposed(placed(p), reduced.data());
  EXPECT_EQ(reduced, of_coordinates(scene.energy, reduced));
  for (int m = 0; m < n; ++m) {
    const VectorXd unit = of_coordinates(scene.energy, VectorXd::Unit(n, m));
    EXPECT_NEAR(force.dot(apply_jacobian(scene.energy, p, unit)), reduced.dot(unit), 1e-14);
  }
}

// A lane each for chains of other lengths; the last lane is empty.
TEST(Articulation, EveryLaneHasJointsOfItsOwn) {
  constexpr int kLast = kWidth<Lanes> - 1;
  std::vector<ChainScene> scenes(static_cast<std::size_t>(kWidth<Lanes>));
  Articulation<Lanes> all = Articulation<Lanes>::room_for(scenes[0].energy.scene().articulation());
  Placement<Lanes> at(6);
  for (int l = 0; l < kLast; ++l) {
    ChainScene& scene = scenes[static_cast<std::size_t>(l)];
    scene.scene.joints[0].on_parent.x() += 0.1 * l;
    scene.scene.joints[0].lower -= 0.1 * l;
    scene.scene.joints[0].upper += 0.2 * l;
    scene.scene.bodies[3].shape = box(2.4 + 0.1 * l, 0.7);
    scene.update();
    all.load(l, scene.energy.scene().articulation());
    const VectorXd p = scattered(scene, 6);
    for (std::size_t m = 0; m < at.p.size(); ++m)
      set_lane(at.p[m], l, p[static_cast<Eigen::Index>(m)]);
  }
  at.update();
  all.close(at);
  for (int l = 0; l < kLast; ++l) {
    const ChainScene& scene = scenes[static_cast<std::size_t>(l)];
    const VectorXd expected = closed(scene.energy, scattered(scene, 6));
    for (std::size_t m = 0; m < at.p.size(); ++m)
      EXPECT_NEAR(lane(at.p[m], l), expected[static_cast<Eigen::Index>(m)], 1e-14);
  }
  for (const Lanes& x : at.p) EXPECT_EQ(lane(x, kLast), 0.0);
  for (std::size_t k = 0; k < all.joints().size(); ++k)
    for (int l = 0; l < kLast; ++l) {
      const Articulation<double>& one =
          scenes[static_cast<std::size_t>(l)].energy.scene().articulation();
      EXPECT_EQ(lane(all.joints()[k].lower, l), one.joints()[k].lower);
      EXPECT_EQ(lane(all.joints()[k].upper, l), one.joints()[k].upper);
      EXPECT_EQ(lane(all.joints()[k].reach, l), one.joints()[k].reach);
    }
}

}  // namespace
}  // namespace rtg::energy
