#include "core/search/policy_learning.hpp"

#include <array>

namespace rtg {
namespace {

constexpr std::array kPrices{0.0, 8.0, 32.0};  // actions

}  // namespace

void learn_step(TreePolicy& policy, const BeamSearch::Growth& step, std::span<const Node> nodes) {
  const Predecessor& c = step.candidate;
  if (!policy.add(c.start, c.action, step.depth)) return;
  for (int k = c.parent, left = step.depth - 1; left > 0; --left) {
    const Node& n = nodes[static_cast<std::size_t>(k)];
    if (!policy.add(n.poses, n.action, n.depth)) return;
    k = n.parent;
  }
}

void learn_episode(TreePolicy& policy, std::span<const Transition> steps) {
  if (steps.empty() || !steps.back().success) return;
  for (std::size_t k = 0; k < steps.size(); ++k)
    policy.add(steps[k].poses, steps[k].action, static_cast<double>(steps.size() - k));
}

void climb(TreePolicy& policy, int first, double before, const PolicyRating& rate,
           const PolicyRating& rate_anew) {
  if (policy.size() == first) return;
  if (before >= 1.0) return policy.forget(first);  // there is nothing to gain
  double price = 0.0, best_price = 0.0, best = -1.0;
  for (const double next : kPrices) {
    policy.raise(first, next - price);
    price = next;
    if (const double rating = rate(policy); rating > best) {
      best = rating;
      best_price = price;
    }
    if (best >= 1.0) break;
  }
  policy.raise(first, best_price - price);
  if (before == 0.0) return;
  if (best > before) {
    TreePolicy without = policy;
    without.forget(first);
    if (best + rate_anew(policy) > before + rate_anew(without)) return;
  }
  policy.forget(first);
}

}  // namespace rtg
