#pragma once

#include <array>
#include <span>
#include <string_view>

namespace rtg {

/// What is compared: learners that differ in where their experience comes from and in little else.
enum class Method { kDqn, kDdqn, kDdqnRandom, kDdqnNaive, kDdqnRtg, kDdqnRtgDr, kHer, kRcg };
inline constexpr std::array<std::string_view, 8> kMethods{
    "dqn", "ddqn", "ddqn_random", "ddqn_naive", "ddqn_rtg", "ddqn_rtg_dr", "her", "rcg"};

/// A value of another section of the configuration.
struct MethodSetting {
  std::string_view section, key, value;
};

/// What `method` stands for, and nothing else tells methods apart: a loader takes these values for
/// the keys that are not given.
///
///   dqn          no offline data, targets of one network  [Mnih et al. 2015]
///   ddqn         the same with Double-Q targets  [van Hasselt et al. 2016]
///   ddqn_random  as ddqn_rtg; the offline data are episodes of the uniform random policy, mixed
///                with the online ones uniformly
///   ddqn_naive   as ddqn_rtg; reverse steps by kinematics alone
///   ddqn_rtg     offline data of reverse trajectory generation
///   ddqn_rtg_dr  the same, all episodes start all over task.randomisation  [App. D]
///   her          as ddqn, with hindsight goals  [Andrychowicz et al. 2017]
///   rcg          as ddqn, with starts grown back from goal states  [Florensa et al. 2017]
///
/// Without offline data, and with random ones, exploration begins at 1 and is uniform over all
/// headings: there is nothing yet to stay near to.
std::span<const MethodSetting> settings_of(Method method);

}  // namespace rtg
