#pragma once

#include <functional>
#include <span>

#include "core/search/beam_search.hpp"
#include "core/search/transition.hpp"
#include "core/search/tree_policy.hpp"

namespace rtg {

/// Adds a step that was found behind one of `nodes`; with it the steps from there to success, as
/// far as the policy lacks them (it may not have taken up the round that found them): a step is of
/// use with the whole plan behind it only. Depths are those of the tree, also behind an entry that
/// bears a price.
void learn_step(TreePolicy& policy, const BeamSearch::Growth& step, std::span<const Node> nodes);

/// Adds the steps of an episode that ended in success, none of any other.
void learn_episode(TreePolicy& policy, std::span<const Transition> steps);

/// How well a policy does, from 0 to 1.
using PolicyRating = std::function<double(const TreePolicy&)>;

/// One step of hill climbing after a round of the search, that has found the entries of `policy`
/// from index `first` on; `before` is the rating without them.
///
/// A depth counts the actions of a plan that nothing disturbs. Where pushes easily go astray it
/// promises too much: the policy leaves what it knew for a plan that it cannot hold. So the new
/// entries are tried at several prices on top of their depth, from none to one at which they serve
/// only where nothing else is near, and get the price that `rate` likes best, of equals the lowest.
///
/// They are forgotten unless the policy is better with them, by `rate` and by the sum of `rate` and
/// `rate_anew`, which has not been asked before: the best of several prices looks better than it
/// is, and a policy that takes up what only seems as good gets a little worse with every round. One
/// that solves nothing has nothing to lose and takes up all.
void climb(TreePolicy& policy, int first, double before, const PolicyRating& rate,
           const PolicyRating& rate_anew);

}  // namespace rtg
