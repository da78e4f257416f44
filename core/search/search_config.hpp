#pragma once

#include <array>
#include <string_view>

namespace rtg {

/// How reverse steps are found; kRandom: not at all, the data are episodes of the random policy.
enum class ReverseMode { kRrbs, kNaive, kRandom };
inline constexpr std::array<std::string_view, 3> kReverseModes{"rrbs", "naive", "random"};

enum class Ranking { kStartDistance, kNovelty, kDisplacement };
inline constexpr std::array<std::string_view, 3> kRankings{"start_distance", "novelty",
                                                           "displacement"};

/// Beam search and the stored data set.
struct SearchConfig {
  ReverseMode reverse = ReverseMode::kRrbs;
  Ranking ranking = Ranking::kStartDistance;
  int transitions = 120000;     // stored in all
  double rollout_share = 0.5;   // of them from roll-outs of the tree policy
  double explored = 6.0;        // steps that the trees find per one of theirs that is stored
  double others = 0.3;          // share of those drawn at random, not as episodes use them
  int breadth = 400;            // B, nodes kept per layer until the policy solves some probe
  int repair_breadth = 50;      // ... from then on, to where it gets lost
  int depth = 40;               // D, layers per round at most
  double contact_quota = 0.4;   // share of the beam reserved for nodes whose step moved an object
  double random_share = 0.15;   // share of the beam drawn at random among the rest
  double gap_tolerance = 0.25;  // a node that misses by more is not expanded [m]
  double turn_tolerance = 0.3;  // nor one whose push turns an object by more [rad]
  double stretch_tolerance = 1.4;  // nor one whose push stretches errors by more
  int twins = 8;                   // disturbed starts that probe how a push stretches errors
  double twin_jitter = 0.3;        // they differ by up to ± this [m]; 1.5 m as 1 rad
  int starts = 2;                  // predecessors of one solve that are replayed, the best ones
  int free_moves = 6;              // steps that move no object replayed per node, the best ones
  int per_layout = 6;              // nodes of a beam that differ in the robot only, at most
  int root_draws = 4;              // goal states drawn per root kept
  int arrivals = 10;               // nodes at its target that end a round
  int patience = 4;                // layers without a better node that end a round
  double target_jitter = 0.25;     // trees aim at the start with objects moved by up to ± this [m]
  double chain_share = 0.1;        // of the steps found from chains replayed end to end
  double mended = 2.0;             // steps of mended and solved episodes per one of theirs stored
  double rollout_jitter = 0.25;    // roll-outs start with objects moved by up to ± this [m]
  double rollout_noise = 0.1;      // share of their actions replaced by a neighbouring heading
  bool randomise = false;          // targets, roll-outs, judgement: ± task.randomisation at least
  int evaluation_starts = 100;     // episodes behind tree_policy_success

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("reverse", reverse, kReverseModes,
             "reverse simulator; random: episodes of the random policy");
    v.choice("ranking", ranking, kRankings, "what a good node is");
    v.integer("transitions", transitions, 1, 100000000, "transitions to store");
    v.number("rollout_share", rollout_share, 0.0, 0.95, "share of them from tree-policy episodes");
    v.number("explored", explored, 1.0, 1e6, "steps found per one of trees stored");
    v.number("others", others, 0.0, 1.0, "share of those drawn at random, used or not");
    v.integer("breadth", breadth, 1, 100000, "nodes kept per layer");
    v.integer("repair_breadth", repair_breadth, 1, 100000,
              "... once the policy solves some starts");
    v.integer("depth", depth, 1, 1000, "layers per round at most");
    v.number("contact_quota", contact_quota, 0.0, 1.0, "share of the beam that moved an object");
    v.number("random_share", random_share, 0.0, 1.0, "share of the beam drawn at random");
    v.number("gap_tolerance", gap_tolerance, 0.0, 100.0, "largest miss of a body expanded [m]");
    v.number("turn_tolerance", turn_tolerance, 0.0, 100.0, "largest turn by a push expanded [rad]");
    v.number("stretch_tolerance", stretch_tolerance, 0.0, 1e9,
             "largest stretch of errors expanded");
    v.integer("twins", twins, 0, 1000, "disturbed starts that probe a push");
    v.number("twin_jitter", twin_jitter, 1e-6, 1.0, "how far they are disturbed [m]");
    v.integer("starts", starts, 1, 100, "predecessors replayed per solve");
    v.integer("free_moves", free_moves, 0, 360, "steps without contact replayed per node");
    v.integer("per_layout", per_layout, 1, 100000, "nodes of a beam with objects alike");
    v.integer("root_draws", root_draws, 1, 1000, "goal states drawn per root kept");
    v.integer("arrivals", arrivals, 1, 1000000, "nodes at its target that end a round");
    v.integer("patience", patience, 1, 1000, "layers without a better node that end a round");
    v.number("target_jitter", target_jitter, 0.0, 10.0, "of the start layout a tree aims at [m]");
    v.number("chain_share", chain_share, 0.0, 0.95, "share of the steps found from whole chains");
    v.number("mended", mended, 0.0, 1e6,
             "steps of episodes, failed ones mended, found per one stored");
    v.number("rollout_jitter", rollout_jitter, 0.0, 10.0, "of the starts of roll-outs [m]");
    v.number("rollout_noise", rollout_noise, 0.0, 1.0, "share of roll-out actions disturbed");
    v.flag("randomise", randomise, "targets, roll-outs and judgement all over task.randomisation");
    v.integer("evaluation_starts", evaluation_starts, 1, 100000, "episodes that judge the data");
  }
};

}  // namespace rtg
