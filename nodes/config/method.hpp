#pragma once

#include <array>
#include <span>
#include <string_view>

namespace rtg::config {

/// The methods that are compared. Nearly all differ only in where the learner's experience comes
/// from.
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

/// A value that a method gives to a key of another section of the configuration.
struct MethodSetting {
  std::string_view section, key, value;
  bool of_task = false;  // how, not what it learns: a task chooses it for all other methods
};

/// Returns the settings of `method`. They are all that distinguishes it from other methods. A
/// loader uses them for keys that are not given.
///
///   dqn           no offline data, targets of one network  [Mnih et al. 2015]
///   ddqn          no offline data, Double-Q targets  [van Hasselt et al. 2016]
///   ddqn_random   offline data of random walks from starts  [App. D]
///   ddqn_scatter  offline data of random walks from goal states
///   ddqn_naive    as ddqn_rtg, but the reverse steps follow from kinematics alone
///   ddqn_forward  as ddqn_rtg, but with the steps of forward beam searches from starts
///   ddqn_rtg      offline data of reverse trajectory generation
///   ddqn_rtg_dr   as ddqn_rtg, with all starts randomised by task.randomisation  [App. D]
///   her           as ddqn, with hindsight goals  [Andrychowicz et al. 2017]
///   rcg           as ddqn, with starts grown back from goal states  [Florensa et al. 2017]
///   cql_rtg       the data of ddqn_rtg without interaction; a penalty lowers the values of
///                 headings that are not in the data  [Kumar et al. 2020]
///   bc_rtg        the data of ddqn_rtg without interaction; imitates the steps of the trees
///   planner       no learning: a forward beam search from each start of the evaluation
///
/// Methods without offline data or with data of random walks explore more. Their ε starts at 1,
/// that of rcg at 0.3. Half of the exploring actions seek contact; the others are uniform, not near
/// the greedy heading, which means nothing yet.
std::span<const MethodSetting> settings_of(Method method);

}  // namespace rtg::config
