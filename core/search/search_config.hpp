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
struct SearchConfig {
  Generator generator = Generator::kRrbs;
  int transitions = 60000;         // stored in all, branches included
  int branches = 4;                // other headings simulated in the state of each stored step
  int near_branches = 1;           // how many of them lie near the heading of the step
  int near_headings = 3;           // largest distance at which a branch is near, in headings
  int breadth = 100;               // B, nodes kept per layer
  int plans_per_node = 2;          // plans simulated per layer, as a multiple of breadth
  double whole_plan_share = 0.05;  // share of plans stored whole; of the rest, the first step
  int depth = 40;                  // D, layers per tree at most
  double contact_quota = 0.4;   // share of the beam reserved for nodes whose step moved an object
  double gap_tolerance = 0.25;  // largest replay error of a body in a step that is used [m]
  int predecessors_per_solve = 2;  // that move an object, replayed per node and action
  int free_moves = 6;              // steps that move no object, replayed per node, the best ones
  int nodes_per_layout = 18;       // most nodes of a beam that differ only in the robot's position
  int root_draws = 4;              // goal states drawn per root of a tree
  int patience = 4;                // consecutive layers without a better node that end a tree
  bool randomise = false;          // starts are jittered by up to task.randomisation

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("generator", generator, kGenerators, "what finds the stored steps");
    v.integer("transitions", transitions, 1, 100000000, "transitions to store");
    v.integer("branches", branches, 0, 359, "other headings simulated per stored step");
    v.integer("near_branches", near_branches, 0, 359, "of them near the step's own");
    v.integer("near_headings", near_headings, 1, 180, "how many headings away, at most");
    v.integer("breadth", breadth, 1, 100000, "nodes kept per layer");
    v.integer("plans_per_node", plans_per_node, 1, 1000, "plans simulated per place in the beam");
    v.number("whole_plan_share", whole_plan_share, 0.0, 1.0,
             "share of successful plans stored whole");
    v.integer("depth", depth, 1, 1000, "layers per tree at most");
    v.number("contact_quota", contact_quota, 0.0, 1.0, "share of the beam that moved an object");
    v.number("gap_tolerance", gap_tolerance, 0.0, 100.0, "largest miss of a body kept [m]");
    v.integer("predecessors_per_solve", predecessors_per_solve, 1, 100,
              "predecessors that move an object, replayed per solve");
    v.integer("free_moves", free_moves, 0, 360, "steps without contact replayed per node");
    v.integer("nodes_per_layout", nodes_per_layout, 1, 100000,
              "nodes of a beam with objects alike");
    v.integer("root_draws", root_draws, 1, 1000, "goal states drawn per root kept");
    v.integer("patience", patience, 1, 1000, "layers without a better node that end a tree");
    v.flag("randomise", randomise, "starts lie all over task.randomisation");
  }
};

}  // namespace rtg::search
