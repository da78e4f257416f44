#pragma once

#include <array>
#include <span>
#include <string_view>

namespace rtg::config {

/// The methods that are compared: learners that differ in where their experience comes from and in
/// little else.
enum class Method {
  kDqn,
  kDdqn,
  kDdqnRandom,
  kDdqnScatter,
  kDdqnNaive,
  kDdqnForward,
  kDdqnRtg,
  kDdqnRtgDr,
  kHer,
  kRcg,
  kCqlRtg,
  kBcRtg,
  kPlanner
};
inline constexpr std::array<std::string_view, 13> kMethods{
    "dqn",         "ddqn", "ddqn_random", "ddqn_scatter", "ddqn_naive", "ddqn_forward", "ddqn_rtg",
    "ddqn_rtg_dr", "her",  "rcg",         "cql_rtg",      "bc_rtg",     "planner"};

/// A value of another section of the configuration.
struct MethodSetting {
  std::string_view section, key, value;
};

/// The settings that `method` stands for; nothing else tells methods apart: a loader takes these
/// values for the keys that are not given.
///
///   dqn           no offline data, targets of one network  [Mnih et al. 2015]
///   ddqn          the same with Double-Q targets  [van Hasselt et al. 2016]
///   ddqn_random   unguided; the steps are those of random walks from starts  [App. D]
///   ddqn_scatter  unguided; ... from goal states
///   ddqn_naive    as ddqn_rtg; reverse steps by kinematics alone
///   ddqn_forward  as ddqn_rtg; the steps are those of beam searches forwards from starts
///   ddqn_rtg      offline data of reverse trajectory generation
///   ddqn_rtg_dr   the same, all episodes start all over task.randomisation  [App. D]
///   her           as ddqn, with hindsight goals  [Andrychowicz et al. 2017]
///   rcg           as ddqn, with starts grown back from goal states  [Florensa et al. 2017]
///   cql_rtg       the data of ddqn_rtg alone, no interaction; values of headings that are not in
///                 them are held down  [Kumar et al. 2020]
///   bc_rtg        the data of ddqn_rtg alone: what the kept steps do is imitated
///   planner       no learning: a beam search forwards from each start that it is evaluated from
///
/// Without offline data, and with those of random walks, exploration begins at 1, seeks contact
/// half of the time and is uniform over all headings else: there is nothing yet to stay near to.
std::span<const MethodSetting> settings_of(Method method);

}  // namespace rtg::config
