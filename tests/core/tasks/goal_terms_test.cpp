// Terms of goals over bodies of any shape: membership, margins and sampled states.

#include <gtest/gtest.h>

#include <numbers>

#include "core/tasks/goal_atoms.hpp"
#include "core/tasks/goal_marks.hpp"
#include "core/tasks/goal_sampler.hpp"
#include "core/world/overlap.hpp"
#include "core/world/separation.hpp"
#include "tests/support/gathering.hpp"
#include "tests/support/touching_scene.hpp"

namespace rtg::tasks {
namespace {

constexpr double kPi = std::numbers::pi;

/// The disc, a T of kind "t", a box of kind "box" and a wall, far apart.
Task letter_and_box() {
  Task task = testing::gathering();
  task.scene.bodies[0].shape = Shape(disc(0.5));
  task.scene.bodies[1] = {"t", "t", testing::letter_t()};
  task.scene.bodies[2] = {"box", "box", box(1.2, 0.8)};
  task.scene.bodies[3] = {"wall", "wall", box(0.5, 6.0), 1.0, 0.5, true};
  task.start = {{0, -5, 0}, {4, 4, 0.5}, {-3, 3, 0.3}, {7, -3, 0}};
  return task;
}

bool holds_at(const Condition& condition, const std::string& kind, const Pose& t, const Pose& b,
              bool negated = false) {
  const Task task = letter_and_box();
  Poses poses = task.start;
  poses[1] = t;
  poses[2] = b;
  return holds({kind, condition, negated}, task, poses);
}

const Pose kAway{-6, -6, 0};

TEST(GoalTerms, AnAngleCountsModuloTheSymmetryOfTheShape) {
  const AngleIn upright{kPi / 2 - 0.2, kPi / 2 + 0.2};
  for (const double turn : {0.0, kPi, -kPi, 3 * kPi}) {
    EXPECT_TRUE(holds_at(upright, "box", kAway, {0, 0, kPi / 2 + 0.15 + turn}));
    EXPECT_FALSE(holds_at(upright, "box", kAway, {0, 0, kPi / 2 + 0.25 + turn}));
  }
  EXPECT_TRUE(holds_at(upright, "t", {0, 0, kPi / 2 - 2 * kPi}, kAway));
  EXPECT_FALSE(holds_at(upright, "t", {0, 0, -kPi / 2}, kAway));
}

TEST(GoalTerms, APoseAsksForPlaceAndAngle) {
  const PoseNear near{{1, 2, 0.4}, 0.3, 0.1};
  EXPECT_TRUE(holds_at(near, "box", kAway, {1.2, 2.2, 0.49 + kPi}));
  EXPECT_FALSE(holds_at(near, "box", kAway, {1.3, 2.2, 0.4}));
  EXPECT_FALSE(holds_at(near, "box", kAway, {1, 2, 0.51}));
}

TEST(GoalTerms, CoversAsksForAShareOfTheBodysOwnOutline) {
  const Covers most{{1, 2, 0.4}, 0.9};
  EXPECT_TRUE(holds_at(most, "box", kAway, {1, 2, 0.4}));
  EXPECT_TRUE(
      holds_at(most, "box", kAway, {1 + 0.1 * std::cos(0.4), 2 + 0.1 * std::sin(0.4), 0.4}));
  EXPECT_FALSE(holds_at(most, "box", kAway, {1.2, 2.2, 0.4}));
  EXPECT_TRUE(holds_at(most, "t", {1, 2, 0.4}, kAway));
  EXPECT_FALSE(holds_at(most, "t", {1, 2, 0.4 + kPi}, kAway));
}

TEST(GoalTerms, TouchingAndApartAreAboutTheNearestOther) {
  const Pose beside{6.0, -3.0, 0.0};  // 0.15 m from the wall
  EXPECT_TRUE(holds_at(Touches{"wall", 0.2}, "box", kAway, beside));
  EXPECT_FALSE(holds_at(Touches{"wall", 0.1}, "box", kAway, beside));
  EXPECT_TRUE(holds_at(KeepsFrom{"wall", 0.1}, "box", kAway, beside));
  EXPECT_FALSE(holds_at(KeepsFrom{"wall", 0.2}, "box", kAway, beside));
  EXPECT_FALSE(holds_at(Touches{"*", 0.2}, "box", kAway, beside)) << "a wall is no movable object";
}

TEST(GoalTerms, ABodyStaysNearItsStart) {
  EXPECT_TRUE(holds_at(Stays{0.5}, "box", kAway, {-3.3, 3.3, 2.0}));
  EXPECT_FALSE(holds_at(Stays{0.5}, "box", kAway, {-3.4, 3.4, 0.3}));
}

TEST(GoalTerms, NotMeansNoBodyOfTheKind) {
  const CentreIn left{HalfPlane{{1, 0}, 0}};
  Task task = letter_and_box();
  task.scene.bodies[1].kind = "box";
  const auto outside = [&](double x1, double x2) {
    Poses poses = task.start;
    poses[1].x = x1;
    poses[2].x = x2;
    return holds({"box", left, true}, task, poses);
  };
  EXPECT_TRUE(outside(1, 2));
  EXPECT_FALSE(outside(1, -2));
  EXPECT_FALSE(outside(-1, -2));
}

TEST(GoalTerms, RegionsMayBePolygons) {
  const CentreIn triangle{Polygon{{{0, 0}, {2, 0}, {0, 2}}}};
  EXPECT_TRUE(holds_at(triangle, "box", kAway, {0.5, 0.5, 0}));
  EXPECT_FALSE(holds_at(triangle, "box", kAway, {1.1, 1.1, 0}));
}

TEST(CommonArea, IsThatOfTheOverlap) {
  const auto moved = [](Polygon polygon, double x, double y, double theta = 0.0) {
    for (Vector2d& v : polygon.vertices) v = rotate(theta, v) + Vector2d(x, y);
    return polygon.vertices;
  };
  const std::vector<Vector2d> square = box(2, 2).vertices;
  EXPECT_NEAR(common_area(square, moved(box(2, 2), 1, 0.5)), 1.5, 1e-12);
  EXPECT_NEAR(common_area(square, moved(box(2, 2), 0, 0, kPi / 4)), 8 * (std::sqrt(2.0) - 1),
              1e-12);
  EXPECT_NEAR(common_area(square, moved(box(1, 1), 0.1, 0.2, 0.3)), 1.0, 1e-12);
  EXPECT_EQ(common_area(square, moved(box(1, 1), 5, 0)), 0.0);
}

/// Draws goal states, which are to be legal and to meet the goal with room to spare.
void expect_sampled(const Task& task, const std::string& which) {
  Rng rng(3);
  for (int draw = 0; draw < 20; ++draw) {
    Refusals refusals;
    const std::optional<Poses> poses = sample_goal(task, rng, &refusals);
    ASSERT_TRUE(poses) << which << ": " << main_reason(refusals, task.scene);
    for (const GoalTerm& term : task.goal)
      EXPECT_TRUE(holds(tightened(term, task.scene), task, *poses)) << which;
    EXPECT_FALSE(first_overlap(task.scene, *poses, 0.02)) << which;
    for (const Joint& joint : task.scene.joints) EXPECT_LT(joint_gap(joint, *poses), 1e-5) << which;
  }
}

/// Two boxes of the kinds "a" and "b", 3 m apart along y, with a joint, and a wall.
Task jointed_boxes(JointType type) {
  Task task = letter_and_box();
  task.scene.bodies[1] = {"a", "a", box(1, 1)};
  task.scene.bodies[2] = {"b", "b", box(1, 1)};
  task.scene.bodies[3] = {"wall", "wall", box(4, 1), 1.0, 0.5, true};
  task.start = {{0, -6, 0}, {5, 0, 0}, {5, 3, 0}, {0, 3, 0}};
  const bool slides = type == JointType::kPrismatic;
  Joint joint{1, 2, {0, slides ? 3.0 : 1.5}, {0, slides ? 0.0 : -1.5}, slides ? 0.0 : -1.0, 1.0};
  joint.type = type;
  joint.axis = Vector2d::UnitY();
  task.scene.joints = {joint};
  return task;
}

// Each term alone.
TEST(GoalTerms, SampledStatesMeetThemWithRoomToSpare) {
  const std::vector<GoalTerm> terms{
      {"t", AngleIn{1.0, 1.4}},
      {"t", PoseNear{{-2, 1, 0.7}, 0.3, 0.2}},
      {"t", Covers{{-2, 1, 0.7}, 0.9}},
      {"t", Covers{{-2, 1, 0.7}, 0.95}},
      {"box", Touches{"wall", 0.1}},
      {"box", Touches{"t", 0.1}},
      {"t", KeepsFrom{"*", 2.0}},
      {"t", Stays{0.3}},
      {"t", CentreIn{Polygon{{{0, 0}, {3, 0}, {0, 3}}}}},
  };
  for (const GoalTerm& term : terms) {
    Task task = letter_and_box();
    task.goal = {term};
    expect_sampled(task, std::to_string(term.condition.index()));
  }
}

// Each leaves little.
TEST(GoalTerms, SampledStatesKeepOutOfNegatedTermsWithRoomToSpare) {
  const std::vector<GoalTerm> terms{
      {"t", AngleIn{0.5, 6.0}, true},
      {"box", AngleIn{0.3, 3.1}, true},
      {"t", PoseNear{{0, 0, 0}, 20.0, 2.8}, true},
      {"t", Covers{{-2, 1, 0.7}, 0.01}, true},
      {"box", Touches{"wall", 6.0}, true},
      {"t", KeepsFrom{"box", 0.1}, true},
      {"t", Stays{10.0}, true},
      {"t", CentreIn{Disc{{0, 0}, 9.0}}, true},
      {"*", MeanIn{Disc{{0, 0}, 6.0}}, true},
  };
  for (const GoalTerm& term : terms) {
    Task task = letter_and_box();
    task.goal = {term};
    expect_sampled(task, "not " + std::to_string(term.condition.index()));
  }
}

// Their joint moves from -1 to 1, from 0 to 1 if it slides.
TEST(GoalTerms, SampledJointsMeetThemWithRoomToSpare) {
  const JointType slides = JointType::kPrismatic;
  const std::vector<GoalTerm> terms{
      {"b", JointIn{0.8, 1.2}},
      {"b", JointIn{-1.2, 0.97}, true},
      {"b", JointIn{-0.97, 0.98}, true},
      {"b", JointIn{0.5, 0.7, slides}},
      {"b", JointIn{-0.1, 0.95, slides}, true},
      {"*", JointIn{0.03, 2.0, slides}, true},
  };
  for (const GoalTerm& term : terms) {
    Task task = jointed_boxes(std::get<JointIn>(term.condition).type);
    task.goal = {term};
    expect_sampled(task, "joint");
    const auto& [least, most, type] = std::get<JointIn>(term.condition);
    const auto inner = std::get<JointIn>(tightened(term, task.scene).condition);
    EXPECT_EQ(inner.least < least, term.negated);
    EXPECT_EQ(inner.most > most, term.negated);
  }
}

TEST(GoalTerms, TermsThatHoldAtOnceAreSampledTogether) {
  Task task = letter_and_box();
  task.goal = {{"t", PoseNear{{5, -2, kPi / 2}, 0.3, 0.2}},
               {"box", Touches{"t", 0.1}},
               {"box", AngleIn{-0.3, 0.3}},
               {"box", CentreIn{HalfPlane{{0, 1}, -2}}}};
  Rng rng(2);
  for (int draw = 0; draw < 20; ++draw) {
    const std::optional<Poses> poses = sample_goal(task, rng);
    ASSERT_TRUE(poses);
    EXPECT_TRUE(succeeded(task, *poses));
  }
}

// The first member has the looser term, so that a place for it is seldom one for the other.
TEST(GoalTerms, OfTwoJointedBodiesAreSampledTogether) {
  const Condition pose = PoseNear{{1, 1, 1}, 0.1, 0.1};
  const std::vector<std::pair<std::string, std::vector<GoalTerm>>> goals{
      {"angle and pose", {{"a", AngleIn{0.8, 1.2}}, {"b", pose}}},
      {"half-plane and pose", {{"a", CentreIn{HalfPlane{{0, 1}, 7}}}, {"b", pose}}},
      {"stays and target", {{"a", Stays{6}}, {"b", Covers{{1, 1, 1}, 0.9}}}},
      {"not and region",
       {{"a", CentreIn{Disc{{5, 0}, 3}}, true}, {"b", CentreIn{Disc{{0, 0}, 0.2}}}}},
      {"regions", {{"a", CentreIn{Disc{{1, -2}, 0.3}}}, {"b", CentreIn{Disc{{1, 1}, 0.3}}}}},
  };
  for (const auto& [which, goal] : goals) {
    Task task = jointed_boxes(JointType::kRevolute);
    task.goal = goal;
    expect_sampled(task, which);
  }
}

TEST(GoalTerms, AJointedBodySlidesIntoTouch) {
  for (const JointType type : {JointType::kRevolute, JointType::kPrismatic})
    for (const double gap : {0.03, 0.1}) {
      Task task = jointed_boxes(type);
      task.goal = {{"b", Touches{"wall", gap}}};
      expect_sampled(task, "b at the wall");
      task.scene.bodies.insert(task.scene.bodies.begin() + 1, {"c", "c", box(1, 1)});
      task.start.insert(task.start.begin() + 1, {-5, 0, 0});
      task.scene.joints[0].parent = 2;
      task.scene.joints[0].child = 3;
      task.goal = {{"c", Touches{"b", gap}}};
      expect_sampled(task, "b at c, which is placed before");
    }
}

TEST(GoalTerms, WhatCannotBeMetIsNamed) {
  Task task = letter_and_box();
  task.goal = {{"t", CentreIn{Disc{{0, 0}, 2}}}, {"t", CentreIn{Disc{{5, 5}, 1}}, false}};
  Rng rng(1);
  Refusals refusals;
  EXPECT_FALSE(sample_goal(task, rng, &refusals));
  EXPECT_EQ(main_reason(refusals, task.scene).substr(0, 11), "task.goal.0");
}

TEST(GoalTerms, WhatMadeATryFailIsNamedNotProposalsThatWereMadeAgain) {
  Task task = testing::gathering();
  task.goal = {{"box", CentreIn{Disc{{0, 0}, 1.5}}}, {"box", KeepsFrom{"box", 9.0}}};
  Rng rng(1);
  Refusals refusals;
  EXPECT_FALSE(sample_goal(task, rng, &refusals));
  EXPECT_EQ(main_term(refusals), 1u) << main_reason(refusals, task.scene);
}

TEST(GoalTerms, TheTermThatFailsMostIsNamedWhateverItsPlace) {
  const GoalTerm rare{"box", Touches{"t", 0.1}}, hopeless{"box", KeepsFrom{"t", 90.0}};
  for (const std::size_t place : {0u, 1u}) {
    Task task = letter_and_box();
    task.goal = {rare, rare};
    task.goal[place] = hopeless;
    Rng rng(1);
    Refusals refusals;
    EXPECT_FALSE(sample_goal(task, rng, &refusals));
    EXPECT_EQ(main_term(refusals), place) << main_reason(refusals, task.scene);
    EXPECT_EQ(refusals.main()->share, 1.0);
  }
}

TEST(GoalMarks, AreRegionsAndTargetOutlines) {
  Task task = letter_and_box();
  task.goal = {{"t", Covers{{1, 2, 0.5}, 0.9}}, {"box", Stays{0.3}}, {"box", AngleIn{0, 1}}};
  const std::vector<GoalMark> marks = goal_marks(task);
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_TRUE(marks[0].target);
  EXPECT_EQ(marks[0].ring.size(), 8u);
  EXPECT_NEAR((marks[1].ring[0] - task.start[2].position()).norm(), 0.3, 1e-12);
}

TEST(GoalMarks, OfAPoseAreEachShapeOfTheKindAndTheTolerances) {
  Task task = letter_and_box();
  task.scene.bodies[2].kind = "t";
  task.scene.bodies[3] = task.scene.bodies[1];  // a shape that is there already
  task.goal = {{"t", PoseNear{{1, 2, 0.5}, 0.2, 0.1}}};
  const std::vector<GoalMark> marks = goal_marks(task);
  ASSERT_EQ(marks.size(), 5u);
  EXPECT_TRUE(marks[0].target && !marks[1].target && marks[2].target && !marks[4].target);
  EXPECT_EQ(marks[0].ring.size(), 8u);
  EXPECT_EQ(marks[2].ring.size(), 4u);
  const Vector2d first = marks[1].ring[1] - Vector2d(1, 2), last = marks[1].ring.back();
  EXPECT_NEAR(std::atan2(first.y(), first.x()), 0.4, 1e-12);
  EXPECT_NEAR(std::atan2(last.y() - 2, last.x() - 1), 0.6, 1e-12);
  EXPECT_NEAR((marks[4].ring[0] - Vector2d(1, 2)).norm(), 0.2, 1e-12);
}

TEST(BodyMarks, OfAnAngleAreItsDirectionsUpToTheBodysSymmetry) {
  Task task = letter_and_box();
  task.goal = {{"box", AngleIn{-0.1, 0.1}}, {"t", AngleIn{-0.1, 0.1}, true}};
  Poses poses = task.start;
  poses[1].theta = poses[2].theta = 3.0;  // the box looks alike after half a turn, the T does not
  const std::vector<GoalMark> marks = body_marks(task, poses);
  ASSERT_EQ(marks.size(), 2u);
  const auto middle = [&](std::size_t mark, std::size_t body) -> Vector2d {
    return marks[mark].ring[marks[mark].ring.size() / 2] - poses[body].position();
  };
  EXPECT_LT(middle(0, 2).x(), -1.05 * task.scene.bodies[2].shape.radius());
  EXPECT_GT(middle(1, 1).x(), 1.05 * task.scene.bodies[1].shape.radius());
  EXPECT_TRUE(!marks[0].negated && marks[1].negated);
}

TEST(BodyMarks, OfDistancesAreTheOtherBodiesGrownByTheGap) {
  Task task = letter_and_box();
  task.goal = {{"t", Touches{"wall", 0.25}}, {"t", KeepsFrom{"*", 0.5}}};
  const std::vector<GoalMark> marks = body_marks(task, task.start);
  ASSERT_EQ(marks.size(), 3u) << "the wall, then the two objects";
  double left = INFINITY;
  for (const Vector2d& v : marks[0].ring) left = std::min(left, v.x());
  EXPECT_NEAR(left, 7.0 - 0.25 - 0.25, 1e-9) << "half the wall's width, and the gap";
  EXPECT_TRUE(!marks[0].negated && marks[1].negated && marks[2].negated);
}

}  // namespace
}  // namespace rtg::tasks
