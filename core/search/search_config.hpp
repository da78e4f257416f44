#pragma once

#include <array>
#include <string_view>

namespace rtg::search {

/// Methods that generate the stored steps. Branches are added to the steps of all of them.
enum class Generator {
  kRrbs,     // trees of reverse steps of the reverse simulator
  kNaive,    // trees of kinematic reverse steps, NaiveReverse
  kForward,  // beam searches forwards from starts
  kScatter,  // random walks from goal states
  kRandom,   // random walks from starts
};
inline constexpr std::array<std::string_view, 5> kGenerators{"rrbs", "naive", "forward", "scatter",
                                                             "random"};

/// Parameters of the beam search and of the stored data set.
///
/// `breadth`: many narrow trees teach more than few wide ones, at the same CPU time per transition.
/// With 100 instead of 10, success first reaches 0.95 after 15,000 instead of 10,000 interactions
/// of Gathering and 22,500 instead of 17,500 of Sorting. Chains keep 100: their first layers are
/// the costliest. Where starts are drawn from ranges, each tree tells of one of them: of four discs
/// that lie anywhere (240,000 transitions, 4 gradient steps) a policy has success 0.02 after 20,000
/// interactions on 7 trees with 100, 0.05 on 24 with 25, 0.13 on 150 with 4 (one seed each).
struct SearchConfig {
  Generator generator = Generator::kRrbs;
  int transitions = 60000;         // stored in all, branches included
  int branches = 4;                // other headings simulated in the state of each stored step
  int breadth = 10;                // B, nodes kept per layer of a tree
  int forward_breadth = 300;       // the same in searches forwards
  int plans_per_node = 4;          // plans simulated per layer, as a multiple of breadth
  double whole_plan_share = 0.05;  // share of plans stored whole; of the rest, the first step
  int depth = 100;                 // D, layers per tree at most; no more than task.horizon
  int predecessors_per_solve = 2;  // considered per node and action, the best ones
  int root_draws = 4;              // goal states drawn per tree, as a multiple of breadth
  int patience = 4;                // consecutive layers without a better node that end a tree
  bool randomise = false;          // starts are jittered by up to task.randomisation
  int shards = 1;  // searches without regard to each other, which share the transitions
  int shard = 0;   // number of the first of them: decides its random numbers, beside the seed

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("generator", generator, kGenerators, "method that generates the transitions");
    v.integer(
        "transitions", transitions, 1, 100000000,
        "transitions to store, branches included; default: 60000 per object whose start is drawn "
        "from a range, 20000 per other one, at least 60000");
    v.integer("branches", branches, 0, 359,
              "other headings also simulated and stored at each stored step");
    v.integer("breadth", breadth, 1, 100000,
              "beam width: largest number of nodes per layer of a tree");
    v.integer("forward_breadth", forward_breadth, 1, 100000,
              "beam width of searches forwards, of the generator forward and the planner");
    v.integer("plans_per_node", plans_per_node, 1, 1000,
              "plans simulated per layer, as a multiple of breadth");
    v.number("whole_plan_share", whole_plan_share, 0.0, 1.0,
             "share of plans stored in full, not only their first step");
    v.integer("depth", depth, 1, 1000,
              "largest number of layers of a search tree, at most task.horizon");
    v.integer("predecessors_per_solve", predecessors_per_solve, 1, 100,
              "predecessors considered per node and heading");
    v.integer("root_draws", root_draws, 1, 1000,
              "goal states drawn for the roots of a tree, as a multiple of breadth");
    v.integer("patience", patience, 1, 1000,
              "end a tree after this many layers in a row no nearer to its start");
    v.flag("randomise", randomise, "shift objects in search starts by up to task.randomisation");
    v.integer("shards", shards, 1, 10000,
              "searches without regard to each other that share the transitions");
    v.integer("shard", shard, 0, 9999, "number of the first of the shards, decides what it finds");
  }
};

/// Returns how many of the transitions shard k = 0 ... shards - 1 is to store.
inline int share_of_shard(const SearchConfig& config, int k) {
  const auto up_to = [&config](long shard) { return config.transitions * shard / config.shards; };
  return static_cast<int>(up_to(k + 1) - up_to(k));
}

}  // namespace rtg::search
