#include "core/learn/double_dqn.hpp"

#include <cstddef>
#include <vector>

#include "core/threads/parallel_for.hpp"

namespace rtg::learn {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::RowVectorXf;

/// The states of the columns from `begin` on.
HeadingNetwork::States columns(const HeadingNetwork::States& all, Index begin, Index count) {
  return {all.data() + begin * all.rows(), all.rows(), count};
}

}  // namespace

DoubleDqn::DoubleDqn(const NetworkSizes& sizes, const TargetRules& rules,
                     const std::vector<double>& strides)
    : rules_(rules), networks_{HeadingNetwork(sizes, strides), HeadingNetwork(sizes, strides)} {
  gradients_.fill(Eigen::VectorXf(weight_count(sizes)));
}

void DoubleDqn::compute(const float* online, const float* target, const Transitions& batch,
                        int threads) {
  const Index count = batch.states.cols(), half = (count + 1) / 2;
  for (RowVectorXf* each : {&values_, &bootstrap_, &targets_}) each->resize(count);
  threads::parallel_for(networks_.size(), threads, [&](std::size_t k) {
    compute_part(networks_[k], online, target, batch, k == 0 ? 0 : half,
                 k == 0 ? half : count - half, gradients_[k].data());
  });
  gradients_[0] += gradients_[1];
}

void DoubleDqn::compute_part(HeadingNetwork& network, const float* online, const float* target,
                             const Transitions& batch, Index begin, Index count, float* gradient) {
  const RowVectorXf next =
      next_values(network, online, target, columns(batch.next_states, begin, count));
  auto bootstrap = bootstrap_.segment(begin, count).array();
  bootstrap = batch.rewards.segment(begin, count).array() +
              static_cast<float>(rules_.discount) *
                  (1.0f - batch.terminated.segment(begin, count).array()) * next.array();
  auto y = targets_.segment(begin, count).array();
  y = bootstrap.max(batch.bounds.segment(begin, count).array());
  if (rules_.clip_targets) y = y.max(0.0f).min(1.0f);

  const auto actions =
      batch.actions.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(count));
  const RowVectorXf& q = network.values_at(online, columns(batch.states, begin, count), actions);
  values_.segment(begin, count) = q;
  const RowVectorXf of_q =
      (q.array() - y).max(-1.0f).min(1.0f) / static_cast<float>(batch.states.cols());
  network.gradient(online, of_q, gradient);
}

/// Returns V(s').
RowVectorXf DoubleDqn::next_values(HeadingNetwork& network, const float* online,
                                   const float* target, const HeadingNetwork::States& next) const {
  if (!rules_.double_q) return network.values(target, next).colwise().maxCoeff();
  const MatrixXf& values = network.values(online, next);
  std::vector<std::int64_t> best(static_cast<std::size_t>(values.cols()));
  RowVectorXf most(values.cols());
  for (Index k = 0; k < values.cols(); ++k)
    most[k] = values.col(k).maxCoeff(&best[static_cast<std::size_t>(k)]);
  const RowVectorXf& value = network.values_at(target, next, best);
  return rules_.clipped_double_q ? RowVectorXf(value.cwiseMin(most)) : value;
}

}  // namespace rtg::learn
