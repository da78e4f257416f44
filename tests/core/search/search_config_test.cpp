#include "core/search/search_config.hpp"

#include <gtest/gtest.h>

#include "core/search/generate.hpp"
#include "tests/support/dragging_world.hpp"
#include "tests/support/each_field.hpp"

namespace rtg::search {
namespace {

/// Returns what a generation in the world without contact stores.
std::vector<Transition> stored(const SearchConfig& config) {
  testing::DraggingWorld world;
  world.drags = {0.2, 0.6, 0.35, testing::kDrag};
  world.aside = 0.2;
  std::vector<Transition> all;
  const GenerationSeams seams{world.solve, world.replay, [&](auto batch) {
                                all.insert(all.end(), batch.begin(), batch.end());
                              }};
  generate(world.task, config, 3, seams);
  return all;
}

TEST(SearchConfig, EachFieldChangesTheStoredTransitions) {
  SearchConfig config;
  config.transitions = 6000;
  config.breadth = 6;
  config.patience = 1;
  config.depth = 60;
  const testing::OtherValues others{
      {"generator", 4},      {"transitions", 1100},
      {"branches", 3},       {"breadth", 7},
      {"plans_per_node", 3}, {"whole_plan_share", 0.5},
      {"depth", 3},          {"predecessors_per_solve", 1},
      {"root_draws", 1},     {"patience", 8},
      {"randomise", 1},      {"shards", 3},
      {"shard", 2},
  };
  testing::expect_each_field_matters(config, others, {"forward_breadth"}, stored);
}

TEST(SearchConfig, ForwardBreadthIsThatOfSearchesForwards) {
  SearchConfig config;
  config.generator = Generator::kForward;
  config.transitions = 400;
  config.forward_breadth = 5;
  const std::vector<Transition> usual = stored(config);
  config.breadth = 3;
  EXPECT_EQ(stored(config), usual);
  config.forward_breadth = 3;
  EXPECT_NE(stored(config), usual);
}

}  // namespace
}  // namespace rtg::search
