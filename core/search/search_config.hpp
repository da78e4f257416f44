#pragma once

#include <array>
#include <string_view>

namespace rtg {

enum class ReverseMode { kRrbs, kNaive };
inline constexpr std::array<std::string_view, 2> kReverseModes{"rrbs", "naive"};

enum class Ranking { kStartDistance, kNovelty, kDisplacement };
inline constexpr std::array<std::string_view, 3> kRankings{"start_distance", "novelty",
                                                           "displacement"};

/// Beam search and the stored data set, design 5.2.
struct SearchConfig {
  ReverseMode reverse = ReverseMode::kRrbs;
  Ranking ranking = Ranking::kStartDistance;
  int transitions = 60000;      // stored in all
  double rollout_share = 0.5;   // of them from roll-outs of the tree policy
  int breadth = 64;             // B, nodes kept per layer
  int depth = 24;               // D, layers per tree at most
  double contact_quota = 0.6;   // share of the beam reserved for nodes whose step moved an object
  double random_share = 0.15;   // share of the beam drawn at random among the rest
  double gap_tolerance = 0.25;  // largest replay gap of a node that is expanded further [m]

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("reverse", reverse, kReverseModes, "reverse simulator: rrbs or naive");
    v.choice("ranking", ranking, kRankings, "what a good node is");
    v.integer("transitions", transitions, 1, 100000000, "transitions to store");
    v.number("rollout_share", rollout_share, 0.0, 0.95, "share of them from tree-policy episodes");
    v.integer("breadth", breadth, 1, 100000, "nodes kept per layer");
    v.integer("depth", depth, 1, 1000, "layers per tree at most");
    v.number("contact_quota", contact_quota, 0.0, 1.0, "share of the beam that moved an object");
    v.number("random_share", random_share, 0.0, 1.0, "share of the beam drawn at random");
    v.number("gap_tolerance", gap_tolerance, 0.0, 100.0, "largest replay gap expanded [m]");
  }
};

}  // namespace rtg
