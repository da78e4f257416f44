#include "core/reverse/problem/reverse_config.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "core/reverse/reverse_simulator.hpp"
#include "tests/support/each_field.hpp"

namespace rtg::reverse {
namespace {

/// Checks the range of every field that it visits.
struct RangeCheck {
  std::set<std::string> names;

  void number(const char* name, double value, double least, double most, const char*) {
    EXPECT_LT(least, most) << name;
    EXPECT_LE(least, value) << name;
    EXPECT_LE(value, most) << name;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
  void integer(const char* name, int value, int least, int most, const char* doc) {
    number(name, value, least, most, doc);
  }
  void flag(const char* name, bool, const char*) { EXPECT_TRUE(names.insert(name).second) << name; }
  template <class Enum, class Names>
  void choice(const char* name, Enum value, const Names& legal, const char*) {
    EXPECT_LT(static_cast<std::size_t>(value), legal.size()) << name;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
};

TEST(ReverseConfig, PresetsLieInTheirOwnRanges) {
  for (const ReversePreset preset : {ReversePreset::kDefault, ReversePreset::kPaper}) {
    ReverseConfig config = reverse_preset(preset);
    EXPECT_EQ(config.preset, preset);
    RangeCheck check;
    config.visit(check);
    EXPECT_FALSE(check.names.empty());
  }
}

TEST(ReverseConfig, ThePaperHasItsOwnObjectiveAndIterations) {
  const ReverseConfig paper = reverse_preset(ReversePreset::kPaper);
  EXPECT_EQ(paper.max_iterations, 1000);
  EXPECT_EQ(paper.path_weight, 0.0);
  EXPECT_EQ(paper.heading_weight, 0.0);
  EXPECT_EQ(paper.terminal_weight, 0.0) << "the final state is fixed";
  EXPECT_GT(paper.plain_barrier, 0.0);
  EXPECT_EQ(paper.late_contacts, 0);
}

/// Solves back pushes that end with a box against the robot, turned a little, and another one
/// behind it.
std::vector<std::tuple<SolveStatus, int, std::vector<Poses>>> solutions(
    const ReverseConfig& config) {
  Scene scene{{{"robot", "robot", regular_polygon(6, 0.8), 1.0, 0.5, false}}};
  for (int k = 0; k < 2; ++k)
    scene.bodies.push_back({"box", "box", box(1.2, 1.2), 1.0, 0.5, false});
  const PushConfig push;
  std::vector<ReverseJob> jobs;
  for (int action = 0; action < push.headings; action += 4)
    jobs.push_back({{{0, 0, 0}, {1.45, 0.2, 0.05}, {2.9, 0.5, 0.3}}, action});
  std::vector<std::tuple<SolveStatus, int, std::vector<Poses>>> found;
  for (const ReverseResult& r : ReverseSimulator(scene, {}, push, config).solve(jobs))
    found.emplace_back(r.status, r.iterations, r.predecessors);
  return found;
}

TEST(ReverseConfig, EachFieldChangesTheSolutions) {
  const testing::OtherValues others{
      {"preset", 1},
      {"kkt", 1},
      {"max_iterations", 5},
      {"feasibility_tol", 1e-2},
      {"stationarity_tol", 1e-9},
      {"robot_weight", 0.5},
      {"object_weight", 0.5},
      {"control_weight", 1e-2},
      {"path_weight", 50},
      {"heading_weight", 50},
      {"speed_weight", 1.0},
      {"terminal_weight", 100},
      {"terminal_tolerance", 1e-6},
      {"plain_barrier", 0.02},
      {"sharpness", 20},
      {"torque_factor", 1},
      {"robot_density", 8},
      {"periodic_turns", 1},
      {"proximal_start", 10},
      {"late_contacts", 2},
  };
  testing::expect_each_field_matters(ReverseConfig{}, others, {}, solutions);
}

TEST(ReverseJob, KeysTellStatesAndActionsApart) {
  const Poses state{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  Poses swapped{state[1], state[0]}, turned = state;
  turned[1].theta += 1e-12;
  const std::set<std::uint64_t> keys{key_of(state, 1), key_of(state, 2), key_of(swapped, 1),
                                     key_of(turned, 1), key_of({state[0]}, 1)};
  EXPECT_EQ(keys.size(), 5U);
  EXPECT_EQ(key_of(ReverseJob{state, 1}), key_of(Poses(state), 1));
  EXPECT_TRUE((ReverseJob{state, 1} == ReverseJob{Poses(state), 1}));
  EXPECT_FALSE((ReverseJob{state, 1} == ReverseJob{turned, 1}));
}

TEST(SolveStatus, EveryEndHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (int k = 0; k < kSolveStatusCount; ++k) names.insert(name(static_cast<SolveStatus>(k)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kSolveStatusCount));
  EXPECT_EQ(name(SolveStatus::kConverged), "converged");
  EXPECT_EQ(name(SolveStatus::kNonFinite), "non_finite");
}

}  // namespace
}  // namespace rtg::reverse
