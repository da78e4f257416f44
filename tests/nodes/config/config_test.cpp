#include "nodes/config/config.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <numbers>
#include <vector>

#include "core/math/rng.hpp"
#include "nodes/config/config_error.hpp"
#include "nodes/config/field_writer.hpp"
#include "nodes/config/train_preset.hpp"
#include "tests/nodes/config/two_boxes.hpp"
#include "tests/support/art_manip.hpp"
#include "tests/support/gathering.hpp"

namespace rtg::config {
namespace {

using testing::gathering;
using testing::gathering_hard;

const std::filesystem::path kConfig = RTG_CONFIG_FOLDER;

Config parsed(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return parse_config(testing::kTwoBoxes + more, "two_boxes.yaml", overrides);
}

/// The visited fields of a struct as text, for comparison.
template <class Section>
std::string text_of(const Section& config) {
  return yaml_text(fields_of(config));
}

std::vector<std::filesystem::path> files() {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kConfig))
    if (entry.path().extension() == ".yaml") found.push_back(entry.path());
  return found;
}

void expect_same_task(const tasks::Task& a, const tasks::Task& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.scene.bodies, b.scene.bodies);
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.scene.joints, b.scene.joints);
  EXPECT_EQ(a.goal, b.goal);
  EXPECT_EQ(text_of(a.push), text_of(b.push));
  EXPECT_EQ(text_of(a), text_of(b));
}

TEST(Config, EveryFileOfOursIsLegalAndItsCanonicalTextReadsBackToItself) {
  EXPECT_GE(files().size(), 3u);
  for (const std::filesystem::path& file : files()) {
    const Config config = load_config(file);
    const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
    EXPECT_EQ(canonical_yaml(again), canonical_yaml(config)) << file;
    EXPECT_EQ(config_json(again), config_json(config)) << file;
    EXPECT_EQ(config_hash(again), config_hash(config)) << file;
    expect_same_task(again.task, config.task);
  }
}

TEST(Config, TheNormalOfAHalfPlaneGetsUnitLength) {
  const Config config =
      parsed("", {"task.goal=[{kind: box, half_plane: {normal: [0.6, 0.805], offset: -1.5}}]"});
  const auto in = std::get<tasks::CentreIn>(config.task.goal.at(0).condition);
  const Vector2d normal = std::get<tasks::HalfPlane>(in.region).normal;
  EXPECT_NEAR(normal.norm(), 1.0, 1e-15);
  EXPECT_NEAR(normal.x() * 0.805, normal.y() * 0.6, 1e-15);
}

TEST(Config, AHalfPlaneMayReachACornerOfTheArenaAlone) {
  const std::string term = "{kind: box, half_plane: {normal: [0.7071, 0.7071], offset: ";
  EXPECT_NO_THROW(parsed("", {"task.goal=[" + term + "-9}}]"}));
  EXPECT_THROW(parsed("", {"task.goal=[" + term + "-12}}]"}), ConfigError);
  const std::string other = "{kind: box, half_plane: {normal: [-0.7071, 0.7071], offset: ";
  EXPECT_NO_THROW(parsed("", {"task.goal=[" + other + "-9}}]"}));
  EXPECT_THROW(parsed("", {"task.goal=[" + other + "-12}}]"}), ConfigError);
}

TEST(Config, TheLayoutsOfTheFilesAreThoseOfTheTests) {
  expect_same_task(load_config(kConfig / "gathering.yaml").task, gathering());
  expect_same_task(load_config(kConfig / "gathering_hard.yaml").task, gathering_hard());
  expect_same_task(load_config(kConfig / "art_manip.yaml").task, testing::art_manip());
}

TEST(Config, WhatIsNotGivenHasTheDefaultOfItsStruct) {
  const Config config = parsed("");
  EXPECT_EQ(text_of(config.physics), text_of(PhysicsConfig{}));
  EXPECT_EQ(text_of(config.reverse), text_of(reverse::ReverseConfig{}));
  EXPECT_EQ(text_of(config.search), text_of(search::SearchConfig{}));
  EXPECT_EQ(text_of(config.train), text_of(TrainConfig{}));
  EXPECT_EQ(config.run.seed, RunConfig{}.seed);
  EXPECT_EQ(config.run.bus, RunConfig{}.bus);
  EXPECT_GE(config.run.workers, 1);  // one per core
}

TEST(Config, EveryFieldIsReadFromItsKey) {
  const Config config = parsed(
      "  horizon: 7\n  start_jitter: 1e-1\n"
      "physics: {skin: +0.01}\n"
      "search: {generator: 'naive', breadth: 12}\n"
      "train: {double_q: false}\n"
      "run: {seed: 5, workers: 3, in_process: true, bus: \"memq://\"}\n");
  EXPECT_EQ(config.task.horizon, 7);
  EXPECT_EQ(config.task.start_jitter, 0.1);
  EXPECT_EQ(config.physics.skin, 0.01);
  EXPECT_EQ(config.search.generator, search::Generator::kNaive);
  EXPECT_EQ(config.search.breadth, 12);
  EXPECT_FALSE(config.train.double_q);
  EXPECT_EQ(config.run.seed, 5);
  EXPECT_EQ(config.run.workers, 3);
  EXPECT_TRUE(config.run.in_process);
  EXPECT_EQ(config.run.bus, "memq://");
}

TEST(Config, APresetChoosesTheDefaultsAndTheOtherKeysOverride) {
  const Config config = parsed(
      "reverse: {max_iterations: 7, preset: paper}\n"
      "train: {preset: paper, target_sync: 9}\n");
  reverse::ReverseConfig reverse = reverse_preset(reverse::ReversePreset::kPaper);
  reverse.max_iterations = 7;
  TrainConfig train = train_preset(TrainPreset::kPaper);
  train.target_sync = 9;
  EXPECT_EQ(text_of(config.reverse), text_of(reverse));
  EXPECT_EQ(text_of(config.train), text_of(train));
}

// Table 2, and without what the preset `default` adds to it.
TEST(Config, ThePresetPaperIsTable2) {
  const TrainConfig train = train_preset(TrainPreset::kPaper);
  EXPECT_EQ(train.batch, 512);
  EXPECT_EQ(train.learning_rate, 5e-5);
  EXPECT_EQ(train.target_rate, 1.0);
  EXPECT_EQ(train.averaging_rate, 1.0);
  EXPECT_EQ(train.offline_share, -1.0);
  EXPECT_EQ(train.recent_share, 0.0);
  EXPECT_EQ(train.nearby_share, 0.0);
  EXPECT_EQ(train.contact_share, 0.0);
  EXPECT_EQ(train.start_jitter, 0.0);
  EXPECT_EQ(train.stop_at_success, 0.0);
  EXPECT_EQ(train.network, Network::kPlain);
  for (const bool added : {train.target_acts, train.clipped_double_q, train.clip_targets,
                           train.value_bounds, train.leave_loops, train.symmetry})
    EXPECT_FALSE(added);
}

TEST(Config, TasksOfManyObjectsGetMoreTransitionsUnlessTheFileTellsHowMany) {
  EXPECT_EQ(parsed("").search.transitions, 60000);
  EXPECT_EQ(load_config(kConfig / "gathering_hard.yaml").search.transitions, 80000);
  EXPECT_EQ(load_config(kConfig / "art_manip.yaml").search.transitions, 90000);
}

TEST(Config, ObjectsThatStartInRangesCountThreefold) {
  std::vector<std::string> overrides{"task.bodies.1.start={x: [-5, -2], y: [0, 4]}"};
  const auto transitions = [&] {
    return load_config(kConfig / "gathering_hard.yaml", overrides).search.transitions;
  };
  EXPECT_EQ(transitions(), 120000);
  overrides.push_back("task.bodies.2.start={x: [2, 5], y: [0, 4]}");
  EXPECT_EQ(transitions(), 160000);
}

TEST(Config, RandomisedStartsAreNoNearerThanTheOthers) {
  Config config = parsed("train: {start_jitter: 0.5}\n");
  for (const auto& [randomise, randomisation, evaluation, training] :
       {std::tuple(false, 2.0, 0.1, 0.5), {true, 2.0, 2.0, 2.0}, {true, 0.3, 0.3, 0.5}}) {
    config.task.start_jitter = 0.1;
    config.task.randomisation = randomisation;
    config.train.randomise = randomise;
    EXPECT_EQ(config.evaluation_jitter(), evaluation);
    EXPECT_EQ(config.training_jitter(), training);
  }
}

TEST(Config, APresetOnTheCommandLineStandsAboveWhatPresetsDecideInTheFile) {
  const std::vector<std::string> overrides{"train.preset=paper", "train.epsilon_start=0.7",
                                           "reverse.preset=paper"};
  TrainConfig train = train_preset(TrainPreset::kPaper);
  train.interactions = 400;
  train.epsilon_start = 0.7;
  const Config config =
      parsed("train: {interactions: 400, target_sync: 9, epsilon_start: 0.5}\n", overrides);
  EXPECT_EQ(text_of(config.train), text_of(train));
  EXPECT_EQ(text_of(config.reverse), text_of(reverse_preset(reverse::ReversePreset::kPaper)));

  // A resolved file gives all keys.
  const std::string resolved = canonical_yaml(parsed("train: {interactions: 400}\n"));
  EXPECT_EQ(text_of(parse_config(resolved, "config.yaml", overrides).train), text_of(train));
}

TEST(Config, SettingsStandAboveTheFileInTheirOrder) {
  const Config config = parsed(
      "search: {breadth: 5, depth: 6}\n",
      {"search.breadth=7", "run.seed=3", "search.breadth=8", "task.bodies.1.start=[3, 1, 0.5]",
       "task.bodies.2.density=2", "physics={skin: 0.01}", "run.bus=memq://"});
  EXPECT_EQ(config.search.breadth, 8);
  EXPECT_EQ(config.search.depth, 6);
  EXPECT_EQ(config.run.seed, 3);
  EXPECT_EQ(config.task.start[1], (Pose{3.0, 1.0, 0.5}));
  EXPECT_EQ(config.task.scene.bodies[2].density, 2.0);
  EXPECT_EQ(config.physics.skin, 0.01);
  EXPECT_EQ(config.run.bus, "memq://");
}

TEST(Config, ABrokenByteInASettingIsNamed) {
  try {
    parsed("", {"task.name=gr\xf6sser"});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()),
              "--set task.name=gr\xf6sser: has a byte that is not UTF-8; legal: text in UTF-8");
  }
}

TEST(Config, APolygonIsCentredAndItsTextReadsBackToTheSameBits) {
  const Config config =
      parsed("", {"task.bodies.1.shape={vertices: [[5, 5], [6.1, 5], [6, 6.5], [5.3, 6.6]]}"});
  const Shape& shape = config.task.scene.bodies[1].shape;
  const Polygon& core = shape.parts()[0].core;
  EXPECT_LT(shape.moments().centroid.norm(), 1e-9);
  EXPECT_NEAR((core.vertices[1] - core.vertices[0]).x(), 1.1, 1e-9);
  EXPECT_EQ(config.task.start[1], (Pose{3.0, 0.0, 0.0}));
  const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
  EXPECT_EQ(again.task.scene.bodies[1].shape, shape);
}

TEST(Config, ShapesOfAllKindsAreCentredAndTheirTextReadsBackToTheSameBits) {
  for (const std::string shape :
       {"{disc: 0.4}", "{box: [1, 0.7], rounding: 0.15}",
        "{regular: {sides: 5, radius: 0.6}, grown: 0.1}",
        "{parts: [{box: [2, 0.5], at: [0.3, 0.9]}, {box: [0.5, 1.5], at: [0.3, -0.1, 0.0]}]}",
        "{parts: [{disc: 0.3, at: [0.7, 0]}, {box: [1, 0.2]}, {disc: 0.3, at: [-0.7, 0]}]}",
        "{vertices: [[0, 0], [2, 0], [2, 0.6], [0.7, 0.6], [0.7, 2], [0, 2]]}"}) {
    const Config config =
        parsed("", {"task.bodies.1.shape=" + shape, "task.bodies.1.start=[0, 0, 0]"});
    const Shape& read = config.task.scene.bodies[1].shape;
    EXPECT_LT(read.moments().centroid.norm(), 1e-9) << shape;
    const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
    EXPECT_EQ(again.task.scene.bodies[1].shape, read) << shape;
  }
}

/// Returns `corners` with `count` points near each edge, off it by up to `off`, as YAML.
std::string with_points_on_edges(const std::vector<Vector2d>& corners, int count, double off,
                                 Rng& rng) {
  std::string text;
  const auto add = [&text](const Vector2d& v) {
    text += (text.empty() ? "[" : ", [") + number_text(v.x()) + ", " + number_text(v.y()) + "]";
  };
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector2d &v = corners[k], to = corners[(k + 1) % corners.size()] - v;
    add(v);
    for (int n = 0; n < count; ++n) {
      const double x = rng.uniform(-off, off), along = (n + rng.uniform(0.2, 0.8)) / count;
      add(v + along * to + Vector2d(x, rng.uniform(-off, off)));
    }
  }
  return text;
}

TEST(Config, ConcavePolygonsWithPointsOnTheirEdgesReadBackToTheSameBits) {
  const std::vector<std::vector<Vector2d>> outlines{
      {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}},                   // L
      {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}};  // U
  Rng rng(1);
  int read = 0;
  for (const double off : {0.0, 1e-9, 1e-7, 1e-5, 1e-3, 1e-2})
    for (int draw = 0; draw < 20; ++draw) {
      const std::string ring = with_points_on_edges(outlines[static_cast<std::size_t>(draw % 2)],
                                                    1 + draw / 2 % 2, off, rng);
      const std::vector<std::string> settings{"task.bodies.1.shape={vertices: [" + ring + "]}",
                                              "task.bodies.1.start=[5, 0, 0]"};
      std::optional<Config> config;
      try {
        config = parsed("", settings);
      } catch (const ConfigError&) {
        continue;  // splits into pieces that are too thin
      }
      ++read;
      EXPECT_NO_THROW({
        const Config again = parse_config(canonical_yaml(*config), "canonical.yaml");
        EXPECT_EQ(canonical_yaml(again), canonical_yaml(*config)) << ring;
      }) << ring;
    }
  EXPECT_GT(read, 60);
}

TEST(Config, RangesOfStartsReadBackToTheSameBits) {
  for (const std::string start :
       {"{x: [-7, 7], y: [2, 4], theta: [-3, 3]}", "{x: 3, y: [2, 4], theta: 0.5}",
        "{in: {disc: {centre: [3, 3], radius: 2}}}",
        "{in: {box: {centre: [3, 3], size: [2, 3], theta: 0.3}}, theta: [0, 1]}"}) {
    const Config config = parsed("", {"task.bodies.1.start=" + start});
    const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
    EXPECT_EQ(again.task.start_ranges, config.task.start_ranges) << start;
    EXPECT_EQ(again.task.start, config.task.start) << start;
    EXPECT_EQ(again.task.start_ranges.size(), 3u);
  }
  EXPECT_TRUE(parsed("").task.start_ranges.empty());
}

TEST(Config, StridesOfTheCommandLineReplaceThoseOfTheFileByEitherKey) {
  for (const std::string given : {"stride: 1.5", "strides: [1.0, 1.5]"}) {
    const std::string file = "  push: {" + given + "}\n";
    EXPECT_EQ(parsed(file, {"task.push.strides=[0.5, 2]"}).task.push.strides,
              (std::vector{0.5, 2.0}));
    EXPECT_EQ(parsed(file, {"task.push.stride=3"}).task.push.strides, std::vector{3.0});
  }
}

TEST(Config, AChainOnABodyWithARangeReadsBackToTheSameBits) {
  for (const std::string joint :
       {"on_parent: [-3, 0], on_child: [3, 0]", "type: prismatic, axis: [1, 2], limits: [-1, 1]",
        "type: fixed"}) {
    const Config config =
        parsed("", {"task.bodies.1.start={x: [2, 4], y: 0.3, theta: [-2.1, 0.3]}",
                    "task.bodies.2.start=[-0.72966, 4.99996, -0.9]",
                    "task.joints=[{parent: a, child: b, " + joint + "}]",
                    "task.goal.0={kind: box, half_plane: {normal: [0, 1], offset: -1}}"});
    EXPECT_LT(joint_gap(config.task.scene.joints[0], config.task.start), 1e-5);
    const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
    expect_same_task(again.task, config.task);
    EXPECT_EQ(config_hash(again), config_hash(config));
  }
}

TEST(Config, RoundingStaysWithinThePolygonAndGrowingAddsToIt) {
  const auto shape = [](const std::string& words) {
    return parsed("", {"task.bodies.1.shape={box: [1.2, 1.0], " + words + "}"})
        .task.scene.bodies[1]
        .shape;
  };
  const double corners = (4.0 - std::numbers::pi) * 0.01;
  EXPECT_NEAR(shape("rounding: 0.1").moments().area, 1.2 - corners, 1e-12);
  EXPECT_NEAR(shape("grown: 0.1").moments().area, 1.4 * 1.2 - corners, 1e-12);
}

TEST(Config, NamesThatYamlReadsAsNothingReadBackToThemselves) {
  const Config config =
      parsed("", {"task.bodies.1.name='null'", "task.bodies.2.name='Null'", "task.name='NULL'"});
  const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
  EXPECT_EQ(canonical_yaml(again), canonical_yaml(config));
  EXPECT_EQ(again.task.name, "NULL");
}

// A place of a fixed y is a thin range of places. With 20 of these radii its ends had no short
// text.
TEST(Config, AThinRangeOfStartsReadsBackToTheBitWithARobotOfAnySize) {
  const std::string file = std::string(RTG_CONFIG_FOLDER) + "/push_t.yaml";
  for (int k = 1; k < 60; ++k) {
    const std::string radius = "task.bodies.0.shape.disc=" + number_text(0.1 * k);
    const Config config =
        load_config(file, {{radius, "task.bodies.1.start={x: [-5, 5], y: 5, theta: [-3.1, 3.1]}"}});
    const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
    EXPECT_EQ(again.task.start_ranges[1], config.task.start_ranges[1]) << radius;
    EXPECT_EQ(canonical_yaml(again), canonical_yaml(config)) << radius;
  }
}

TEST(Config, TheHashTellsConfigurationsApart) {
  const auto with_breadth = [](int breadth) {
    return config_hash(parsed("search: {breadth: " + std::to_string(breadth) + "}\n"));
  };
  EXPECT_EQ(config_hash(parsed("")), with_breadth(search::SearchConfig{}.breadth));
  EXPECT_NE(config_hash(parsed("")), with_breadth(search::SearchConfig{}.breadth + 1));
}

TEST(NumberText, IsTheShortestThatReadsBackAndIsARealForYamlAndJson) {
  EXPECT_EQ(number_text(20.0), "20.0");
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-0.0), "-0.0");
  EXPECT_EQ(number_text(1e-5), "1.0e-05");
  EXPECT_EQ(number_text(1.5e300), "1.5e+300");
  EXPECT_EQ(number_text(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(single_text(1.13f), "1.13");
  EXPECT_EQ(single_text(std::numeric_limits<float>::min()), "1.1754944e-38");
}

/// The message that a configuration is refused with.
std::string refusal(const std::string& more, const std::vector<std::string>& overrides = {}) {
  try {
    (void)parsed(more, overrides);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(Config, DynamicModeNeedsDamping) {
  EXPECT_TRUE(parsed("physics: {inertia: true, damping: 0.05}\n").physics.inertia);
  EXPECT_TRUE(
      refusal("physics: {inertia: true, damping: 0.04}\n")
          .ends_with(
              ": key 'physics.damping': 0.04 is too small with physics.inertia: true; legal: "
              "0.05 or more"));
}

TEST(Config, AMethodGivesTheValuesThatAreNotGiven) {
  const Config config = parsed(
      "train: {epsilon_start: 0.5}\n"
      "run: {method: her}\n");
  TrainConfig train;
  train.offline = false;
  train.epsilon_start = 0.5;  // of the file
  train.epsilon_end = 0.05;
  train.nearby_share = 0.0;
  train.contact_share = 0.5;
  train.hindsight = 4;
  train.symmetry = false;
  train.learning_rate = 1e-4;
  EXPECT_EQ(config.run.method, Method::kHer);
  EXPECT_EQ(text_of(config.train), text_of(train));
}

TEST(Config, AMethodAmongTheOverridesStandsAboveTheFileButNotAboveTheOthers) {
  const std::string file =
      "search: {generator: naive}\ntrain: {hindsight: 9, epsilon_start: 0.5}\n";
  const std::vector<std::string> overrides{"train.epsilon_start=0.7", "run.method=dqn",
                                           "train.preset=paper"};
  TrainConfig train = train_preset(TrainPreset::kPaper);
  train.offline = train.double_q = false;
  train.epsilon_start = 0.7;
  train.contact_share = 0.5;
  EXPECT_EQ(text_of(parsed(file, overrides).train), text_of(train));
  EXPECT_EQ(parsed(file, overrides).search.generator, search::Generator::kRrbs);
  EXPECT_EQ(parsed(file).search.generator, search::Generator::kNaive);
}

/// The configuration of a file for a method of the command line.
Config for_method(const std::string& file, const std::string& method) {
  return parsed(file, {"run.method=" + method});
}

TEST(Config, ABreadthOfTheTaskIsThatOfEachMethodThatHasNoneOfItsOwn) {
  const std::string task = "search: {breadth: 70}\n";
  EXPECT_EQ(for_method(task, "ddqn_rtg").search.breadth, 70);
  EXPECT_EQ(for_method(task, "bc_rtg").search.breadth, 70);
  EXPECT_EQ(for_method(task, "ddqn_naive").search.breadth, 100);
  const std::string naive = "search: {breadth: 100}\nrun: {method: ddqn_naive}\n";
  EXPECT_EQ(for_method(naive, "ddqn_rtg").search.breadth, search::SearchConfig{}.breadth);
}

TEST(Config, ALearningRateOfTheTaskIsThatOfEachMethodThatHasNoneOfItsOwn) {
  const std::string task = "train: {learning_rate: 0.002}\n";
  EXPECT_EQ(for_method(task, "ddqn_rtg").train.learning_rate, 0.002);
  EXPECT_EQ(for_method(task, "her").train.learning_rate, 1e-4);
  const std::string of_her = canonical_yaml(for_method("", "her"));
  const Config other = parse_config(of_her, "config.yaml", {{"run.method=ddqn_rtg"}});
  EXPECT_EQ(other.train.learning_rate, TrainConfig{}.learning_rate);
}

TEST(Config, CloningImitatesTheStepsOfTrees) {
  const std::vector<std::string> cloning{"train.learner=cloning", "train.interact=false"};
  EXPECT_EQ(refusal("search: {generator: rrbs}\n", cloning), "none");
  EXPECT_EQ(refusal("search: {generator: naive}\n", cloning), "none");
  EXPECT_NE(refusal("search: {generator: forward}\n", cloning), "none");
}

TEST(Config, WhatAMethodStandsForReadsBackToItself) {
  for (const std::string_view name : kMethods) {
    const std::vector<std::string> method{"run.method=" + std::string(name),
                                          "task.randomisation=0.3"};
    const Config config = parsed("", method);
    const Config again = parse_config(canonical_yaml(config), "canonical.yaml");
    EXPECT_EQ(canonical_yaml(again), canonical_yaml(config)) << name;
  }
}

TEST(Config, DomainRandomisationNeedsItsRange) {
  EXPECT_EQ(refusal("", {"train.randomise=true"}),
            "--set train.randomise=true: key 'task.randomisation': is 0, but train.randomise is "
            "true; legal: more than 0");
}

}  // namespace
}  // namespace rtg::config
