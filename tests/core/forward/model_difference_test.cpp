// How far the step energy's model and Box2D are apart after one push.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/forward/box2d_simulator.hpp"
#include "core/forward/newton_simulator.hpp"
#include "tests/support/random_push.hpp"

namespace rtg::forward {
namespace {

constexpr std::uint64_t kScenes = 200;
constexpr double kRobotRadius = 0.8;  // of the random scenes [m]

/// Mean over the bodies of the distance between their positions [m], as the replay gap of Fig. 16.
double difference(const Poses& a, const Poses& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i].position() - b[i].position()).norm();
  return sum / static_cast<double>(a.size());
}

/// Distances [m] and angles [rad] between the two poses of each object that a push has moved.
struct MovedObjects {
  std::vector<double> distances = {}, angles = {};

  void add(const Poses& start, const Poses& a, const Poses& b) {
    for (std::size_t i = 1; i < start.size(); ++i) {
      if ((b[i].position() - start[i].position()).norm() < 0.05) continue;
      distances.push_back((a[i].position() - b[i].position()).norm());
      angles.push_back(std::abs(a[i].theta - b[i].theta));
    }
    std::ranges::sort(distances);
    std::ranges::sort(angles);
  }
};

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// Prints the differences over the random scenes and expects them to be small.
void expect_small_differences(bool compound) {
  const PushConfig push;
  const PhysicsConfig physics;
  std::vector<double> differences;
  MovedObjects moved;
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    const testing::RandomPush drawn = testing::random_push(seed, push, compound);
    const PushOutcome newton =
        NewtonSimulator(drawn.scene, push, physics).push(drawn.start, drawn.action);
    const PushOutcome box2d =
        Box2dSimulator(drawn.scene, push, physics).push(drawn.start, drawn.action);
    ASSERT_TRUE(newton.ok && box2d.ok) << seed;
    differences.push_back(difference(newton.end, box2d.end));
    moved.add(drawn.start, newton.end, box2d.end);
  }
  std::sort(differences.begin(), differences.end());
  std::printf("Newton against Box2D, %d pushes: median %.4f, 90%% %.4f, largest %.4f m\n",
              static_cast<int>(kScenes), quantile(differences, 0.5), quantile(differences, 0.9),
              quantile(differences, 1.0));
  std::printf("  objects that moved: median %.4f m, %.4f rad; 90%% %.4f m, %.4f rad\n",
              quantile(moved.distances, 0.5), quantile(moved.angles, 0.5),
              quantile(moved.distances, 0.9), quantile(moved.angles, 0.9));
  EXPECT_LE(quantile(differences, 0.5), 0.03 * kRobotRadius);
  EXPECT_LE(quantile(differences, 0.9), 0.1);
  // The barrier acts at a distance, so that an object moves farther than where bodies touch.
  EXPECT_LE(quantile(moved.distances, 0.5), 0.07);
  EXPECT_LE(quantile(moved.angles, 0.5), 0.08);
}

TEST(ModelDifference, OfPolygonsIsSmall) { expect_small_differences(false); }

TEST(ModelDifference, OfRoundAndCompoundBodiesIsSmall) { expect_small_differences(true); }

}  // namespace
}  // namespace rtg::forward
