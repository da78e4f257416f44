#include "nodes/config/method.hpp"

#include <utility>
#include <vector>

namespace rtg::config {
namespace {

using Settings = std::vector<MethodSetting>;

/// Adds the exploration settings of a learner without data of a search. It has to find successes by
/// its own exploration. What `more` gives stays.
Settings unguided(Settings more) {
  const Settings exploration{{"train", "epsilon_start", "1.0"},
                             {"train", "epsilon_end", "0.05"},
                             {"train", "nearby_share", "0.0"},
                             {"train", "contact_share", "0.5"}};
  more.insert(more.end(), exploration.begin(), exploration.end());
  return more;
}

/// Adds the settings of a learner that learns from its own experience alone.
Settings online(Settings more) {
  more.push_back({"train", "offline", "false"});
  return unguided(std::move(more));
}

/// Returns the settings of all methods, in the order of Method.
const std::array<Settings, kMethods.size()>& table() {
  static const std::array<Settings, kMethods.size()> kTable{
      online({{"train", "double_q", "false"}}),
      online({{"train", "double_q", "true"}}),
      // Uniform mixing: otherwise half of every batch would be walks, which hardly ever succeed.
      unguided({{"search", "generator", "random"}, {"train", "offline_share", "-1.0"}}),
      unguided({{"search", "generator", "scatter"}, {"train", "offline_share", "0.25"}}),
      // Few kinematic steps come out in the simulator: narrow trees of them end early.
      Settings{{"search", "generator", "naive"}, {"search", "breadth", "100", true}},
      Settings{{"search", "generator", "forward"}},
      Settings{{"search", "generator", "rrbs"}},
      Settings{{"search", "generator", "rrbs"},
               {"search", "randomise", "true"},
               {"train", "randomise", "true"}},
      // train/rtg/learn/hindsight.py says why.
      online({{"train", "double_q", "true"},
              {"train", "hindsight", "4"},
              {"train", "symmetry", "false", true},
              {"train", "learning_rate", "1.0e-04", true}}),
      // Starts are solved sometimes only by a policy that acts from the first interaction on.
      online({{"train", "double_q", "true"},
              {"train", "curriculum", "0.9"},
              {"train", "learning_rate", "1.0e-04", true},
              {"train", "epsilon_start", "0.3"}}),
      Settings{{"search", "generator", "rrbs"},
               {"train", "interact", "false"},
               {"train", "cql_weight", "1.0"}},
      Settings{{"search", "generator", "rrbs"},
               {"train", "interact", "false"},
               {"train", "learner", "cloning"},
               {"train", "learning_rate", "1.0e-04", true}},
      Settings{{"train", "offline", "false"},
               {"train", "interact", "false"},
               {"train", "learner", "planning"}},
  };
  return kTable;
}

}  // namespace

std::span<const MethodSetting> settings_of(Method method) {
  return table()[static_cast<std::size_t>(method)];
}

}  // namespace rtg::config
