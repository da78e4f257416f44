#include "nodes/jobs/services.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "nodes/bus/wire.hpp"

namespace rtg::jobs {
namespace {

constexpr TaskShape kShape{.bodies = 2, .actions = 48};

Poses state(double x) { return {{x, x + 0.25, 0.1}, {-x, 1.0 / 3.0, 7.0}}; }

std::vector<reverse::ReverseJob> reverse_jobs() {
  return {{state(1.0), 0}, {state(2.0), 47, true}};
}
std::vector<search::ReplayJob> replay_jobs() {
  return {{state(1.0), search::kSettle}, {state(2.0), 47}};
}

std::vector<reverse::ReverseResult> reverse_results() {
  return {{reverse::SolveStatus::kConverged, 12, {state(3.0), state(5.0)}, 0.5},
          {reverse::SolveStatus::kNonFinite, 0, {}, 0.25},
          {reverse::SolveStatus::kConverged, 7, {state(4.0)}, 0.0}};
}

/// reverse_results(), of which the first and the last have a solution of two sub-steps.
std::vector<reverse::ReverseResult> results_with_solutions() {
  std::vector<reverse::ReverseResult> results = reverse_results();
  const reverse::ContactForce touch{2, 1, 0, {0.5, 0.25}, {0.6, -0.8}, 7.5};
  reverse::ReverseSolution solution{{state(1.0), state(2.0), state(3.0)},
                                    {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}},
                                    {{0, 1, 0, {0, 1}, {1, 0}, 3.0}, touch},
                                    12.5,
                                    1e-7,
                                    1e-5};
  results[0].solution = solution;
  solution.controls[1].z() = -1.0 / 3.0;
  solution.contacts = {touch};
  results[2].solution = solution;
  return results;
}
std::vector<search::ReplayResult> replay_results() {
  return {{state(3.0), true, 0.5}, {state(4.0), false, 0.0}};
}

/// The message after a flight over the wire.
template <class Message>
Message flown(Message message) {
  Message out{};
  EXPECT_FALSE(bus::decode(bus::encode(message), out).has_value());
  return out;
}

TEST(Service, JobsAndResultsSurviveTheWireBitForBit) {
  EXPECT_EQ(ReverseService::parse(flown(ReverseService::message(reverse_jobs())), kShape),
            reverse_jobs());
  EXPECT_EQ(ReplayService::parse(flown(ReplayService::message(replay_jobs())), kShape),
            replay_jobs());

  const auto solved =
      ReverseService::parse(flown(ReverseService::message(results_with_solutions())), kShape);
  ASSERT_TRUE(solved && solved->size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const reverse::ReverseResult &got = (*solved)[k], wanted = results_with_solutions()[k];
    EXPECT_EQ(got.solution, wanted.solution);
    EXPECT_EQ(got.status, wanted.status);
    EXPECT_EQ(got.iterations, wanted.iterations);
    EXPECT_EQ(got.predecessors, wanted.predecessors);
    EXPECT_EQ(got.cpu_s, wanted.cpu_s);
  }
  const auto replayed =
      ReplayService::parse(flown(ReplayService::message(replay_results())), kShape);
  ASSERT_TRUE(replayed && replayed->size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const search::ReplayResult &got = (*replayed)[k], wanted = replay_results()[k];
    EXPECT_EQ(got.ok, wanted.ok);
    EXPECT_EQ(got.end, wanted.end);
    EXPECT_EQ(got.cpu_s, wanted.cpu_s);
  }
}

/// Returns whether a message is refused once `spoil` has been at it.
template <class Service, class Items>
bool refused(const Items& items,
             const std::function<void(decltype(Service::message(items))&)>& spoil,
             const TaskShape& shape = kShape) {
  auto message = Service::message(items);
  EXPECT_TRUE(Service::parse(message, kShape).has_value());
  spoil(message);
  return !Service::parse(message, shape).has_value();
}

TEST(Service, JobsThatMakeNoSenseAreRefused) {
  EXPECT_TRUE(refused<ReverseService>(reverse_jobs(), [](auto& m) { m.action[1] = 48; }));
  EXPECT_TRUE(
      refused<ReverseService>(reverse_jobs(), [](auto& m) { m.action[0] = search::kSettle; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_jobs(), [](auto& m) { m = {}; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_jobs(), [](auto&) {}, {.bodies = 3, .actions = 48}));
  EXPECT_TRUE(refused<ReplayService>(replay_jobs(), [](auto& m) { m.action[1] = 48; }));
  EXPECT_TRUE(refused<ReplayService>(replay_jobs(), [](auto& m) { m.action[0] = -2; }));
  EXPECT_TRUE(refused<ReplayService>(replay_jobs(), [](auto&) {}, {.bodies = 1, .actions = 48}));
}

TEST(Service, ResultsThatMakeNoSenseAreRefused) {
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m.status[0] = 7; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m.status[0] = -1; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m.iterations[0] = -1; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m.cpu_s[1] = -0.1; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m = {}; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m.starts[2] = 2; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m.starts[2] = 0; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m.starts = {2, 1, 0}; }));
  EXPECT_TRUE(refused<ReverseService>(reverse_results(), [](auto& m) { m.starts[0] = -1; }));
  EXPECT_TRUE(
      refused<ReverseService>(reverse_results(), [](auto&) {}, {.bodies = 3, .actions = 48}));
  EXPECT_TRUE(refused<ReplayService>(replay_results(), [](auto& m) { m.ok[0] = 2; }));
  EXPECT_TRUE(refused<ReplayService>(replay_results(), [](auto& m) { m.cpu_s[1] = 1e300; }));
  EXPECT_TRUE(refused<ReplayService>(replay_results(), [](auto&) {}, {.bodies = 3, .actions = 48}));
}

TEST(Service, SolutionsThatMakeNoSenseAreRefused) {
  using Message = ReverseService::ResultMessage;
  const std::function<void(Message&)> spoils[] = {
      [](Message& m) { m.solved[0] = 2; },           [](Message& m) { m.solved = {1, 0, 0}; },
      [](Message& m) { m.sub_steps = 3; },           [](Message& m) { m.sub_steps = -1; },
      [](Message& m) { m.n_trajectory -= 6; },       [](Message& m) { m.n_controls -= 3; },
      [](Message& m) { m.contacts = {3, 1}; },       [](Message& m) { m.contacts = {-1, 4}; },
      [](Message& m) { m.contact_sub_step[0] = 3; }, [](Message& m) { m.contact_body[1] = 2; },
      [](Message& m) { m.contact_other[2] = -1; }};
  for (const auto& spoil : spoils)
    EXPECT_TRUE(refused<ReverseService>(results_with_solutions(), spoil)) << &spoil - spoils;
  EXPECT_TRUE(refused<ReverseService>(reverse_jobs(), [](auto& m) { m.with_solution[0] = 2; }));
}

TEST(Service, SolutionsThatDoNotFitIntoAMessageAreLeftOut) {
  std::vector<reverse::ReverseResult> results = results_with_solutions();
  results[1].solution = results[0].solution;
  results[1].solution->contacts.resize(2000);
  const auto got = ReverseService::parse(flown(ReverseService::message(results)), kShape);
  ASSERT_TRUE(got && got->size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_FALSE((*got)[k].solution.has_value());
    EXPECT_EQ((*got)[k].predecessors, results[k].predecessors);
  }
}

TEST(Service, UnitsAreAsEqualAsCanBeAndFitIntoMessages) {
  const UnitLimit limit{.jobs = 48, .states = reverse::kMaxPredecessors};
  EXPECT_EQ(unit_sizes(0, limit, kShape), std::vector<std::size_t>{});
  EXPECT_EQ(unit_sizes(48, limit, kShape), std::vector<std::size_t>{48});
  EXPECT_EQ(unit_sizes(98, limit, kShape), (std::vector<std::size_t>{32, 33, 33}));
  for (const int bodies : {2, 64, 200}) {
    const TaskShape shape{bodies, 48};
    const auto sizes = unit_sizes(1000, limit, shape);
    EXPECT_EQ(std::accumulate(sizes.begin(), sizes.end(), 0U), 1000U);
    const std::vector<reverse::ReverseResult> results(
        *std::max_element(sizes.begin(), sizes.end()),
        {reverse::SolveStatus::kConverged, 1,
         std::vector<Poses>(reverse::kMaxPredecessors, Poses(static_cast<std::size_t>(bodies)))});
    auto message = ReverseService::message(results);
    EXPECT_NO_THROW(bus::encode(message)) << bodies;
  }
}

TEST(Service, AUnitIsNamedByEverythingThatIsAsked) {
  const auto jobs = reverse_jobs();
  const std::int64_t id = unit_id(jobs, 5);
  EXPECT_EQ(unit_id(reverse_jobs(), 5), id);
  EXPECT_NE(unit_id(jobs, 6), id);
  auto other = jobs;
  other[1].action = 46;
  EXPECT_NE(unit_id(other, 5), id);
  other = jobs;
  other[0].end[1].theta = std::nextafter(7.0, 8.0);
  EXPECT_NE(unit_id(other, 5), id);
  other = jobs;
  other[0].with_solution = true;
  EXPECT_NE(unit_id(other, 5), id);
  EXPECT_NE(unit_id(std::span(jobs).first(1), 5), id);
}

}  // namespace
}  // namespace rtg::jobs
