#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "core/learn/adam.hpp"
#include "core/learn/double_dqn.hpp"
#include "core/learn/heading_network.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg::bindings {
namespace {

using learn::DoubleDqn;
using learn::HeadingNetwork;
using learn::LearnerWeights;
using learn::NetworkSizes;
using learn::StepRates;
using learn::Transitions;
using Floats = nb::ndarray<const float, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using FloatsOut = nb::ndarray<float, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using StateRows = nb::ndarray<const float, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Result = nb::ndarray<nb::numpy, float>;

[[noreturn]] void refuse(const std::string& what) { throw nb::value_error(what.c_str()); }

void check_weights(const NetworkSizes& sizes, std::size_t count) {
  const int legal = weight_count(sizes);
  if (count != static_cast<std::size_t>(legal))
    refuse(std::to_string(count) + " weights; legal: " + std::to_string(legal));
}

void check_states(const NetworkSizes& sizes, const StateRows& states) {
  if (states.shape(1) != static_cast<std::size_t>(sizes.inputs))
    refuse("states of " + std::to_string(states.shape(1)) +
           " numbers; legal: " + std::to_string(sizes.inputs));
}

/// The rows of a numpy array as columns.
HeadingNetwork::States columns(const StateRows& rows) {
  return {rows.data(), static_cast<Eigen::Index>(rows.shape(1)),
          static_cast<Eigen::Index>(rows.shape(0))};
}

/// A copy of the numbers of a matrix, column by column.
template <class Matrix>
Result copied(const Matrix& matrix, std::initializer_list<std::size_t> shape) {
  OwnedArray<float> out(static_cast<std::size_t>(matrix.size()));
  std::copy_n(matrix.data(), matrix.size(), out.data.get());
  return out.release(shape);
}

Result values(HeadingNetwork& network, const Floats& weights, const StateRows& states) {
  check_weights(network.sizes(), weights.shape(0));
  check_states(network.sizes(), states);
  const auto actions = static_cast<std::size_t>(network.actions());
  const auto compute = [&]() -> auto& {
    const nb::gil_scoped_release release;
    return network.values(weights.data(), columns(states));
  };
  return copied(compute(), {states.shape(0), actions});
}

Transitions::Numbers numbers(const Floats& array) {
  return {array.data(), static_cast<Eigen::Index>(array.shape(0))};
}

/// The arrays of a gradient step, one row or entry per transition.
struct TransitionArrays {
  StateRows states;
  ActionArray actions;
  StateRows next_states;
  Floats rewards, terminated, bounds;

  std::size_t count() const { return states.shape(0); }

  void check(const HeadingNetwork& network) const {
    const NetworkSizes& sizes = network.sizes();
    check_states(sizes, states);
    check_states(sizes, next_states);
    if (count() == 0 || next_states.shape(0) != count())
      refuse(std::to_string(count()) + " states and " + std::to_string(next_states.shape(0)) +
             " next states; legal: as many, at least 1");
    check_actions(actions, count(), network.actions());
    for (const Floats& each : {rewards, terminated, bounds})
      if (each.shape(0) != count())
        refuse(std::to_string(each.shape(0)) + " numbers for " + std::to_string(count()) +
               " transitions; legal: one per transition");
  }

  Transitions view() const {
    return {.states = columns(states),
            .actions = {actions.data(), count()},
            .next_states = columns(next_states),
            .rewards = numbers(rewards),
            .terminated = numbers(terminated),
            .bounds = numbers(bounds)};
  }
};

/// The arrays of LearnerWeights.
struct WeightArrays {
  FloatsOut online, target, mean, first_moment, second_moment;

  void check(const NetworkSizes& sizes) const {
    for (const FloatsOut& each : {online, target, mean, first_moment, second_moment})
      check_weights(sizes, each.shape(0));
  }

  LearnerWeights view() const {
    return {.online = online.data(),
            .target = target.data(),
            .mean = mean.data(),
            .first_moment = first_moment.data(),
            .second_moment = second_moment.data()};
  }
};

std::tuple<Result, Result, Result> step(DoubleDqn& learner, const WeightArrays& weights,
                                        const TransitionArrays& batch, const StepRates& rates,
                                        int threads) {
  weights.check(learner.network().sizes());
  batch.check(learner.network());
  if (threads < 1) refuse(std::to_string(threads) + " threads; legal: at least 1");
  {
    const nb::gil_scoped_release release;
    const LearnerWeights view = weights.view();
    learner.compute(view.online, view.target, batch.view(), threads);
    descend(learner.gradient().data(), static_cast<int>(learner.gradient().size()), view, rates);
  }
  const std::size_t count = batch.count();
  return {copied(learner.values(), {count}), copied(learner.targets(), {count}),
          copied(learner.bootstrap(), {count})};
}

}  // namespace

void bind_network(nb::module_& module) {
  module.attr("MAX_GRADIENT_NORM") = learn::kMaxGradientNorm;
  nb::class_<HeadingNetwork>(module, "HeadingNetwork",
                             R"(Values of headings; see core/learn/heading_network.hpp.

Arrays are float32 and contiguous; `weights` [W] lie in the order of PyTorch's parameters.
Raises ValueError if shapes do not fit. One thread at a time may use it.)")
      .def(
          "__init__",
          [](HeadingNetwork* network, int inputs, int headings, int hidden, int features,
             const std::vector<double>& strides) {
            new (network) HeadingNetwork({inputs, headings, hidden, features}, strides);
          },
          nb::arg("inputs"), nb::arg("headings"), nb::arg("hidden"), nb::arg("features"),
          nb::arg("strides"))
      .def("values", &values, nb::arg("weights"), nb::arg("states"),
           "Returns Q of all actions. states [B, inputs] -> [B, actions]");
  nb::class_<TransitionArrays>(
      module, "TransitionArrays",
      "The arrays of a gradient step, one row or entry per transition; float32, contiguous.")
      .def(nb::init<StateRows, ActionArray, StateRows, Floats, Floats, Floats>(), nb::arg("states"),
           nb::arg("actions"), nb::arg("next_states"), nb::arg("rewards"), nb::arg("terminated"),
           nb::arg("bounds"), "`states`, `next_states` [B, inputs], all else [B].");
  nb::class_<WeightArrays>(
      module, "WeightArrays",
      R"(The weights of a learner and the moments of its optimiser, float32 [W] each.

The moments are zeros before the first step.)")
      // Not converted: a step would change a copy.
      .def(nb::init<FloatsOut, FloatsOut, FloatsOut, FloatsOut, FloatsOut>(),
           nb::arg("online").noconvert(), nb::arg("target").noconvert(),
           nb::arg("mean").noconvert(), nb::arg("first_moment").noconvert(),
           nb::arg("second_moment").noconvert());
  nb::class_<StepRates>(module, "StepRates",
                        "How far a gradient step moves the weights; see core/learn/adam.hpp.")
      .def(nb::init<long, double, double, double>(), nb::kw_only(), nb::arg("step"),
           nb::arg("learning"), nb::arg("target"), nb::arg("mean"),
           "`step`: its number, counted from 1; `target`, `mean`: shares of the way, from 0 to 1.");
  nb::class_<DoubleDqn>(module, "DoubleDqn",
                        R"(Gradient steps of Double Q-learning; see core/learn/double_dqn.hpp.

Arrays and errors as those of HeadingNetwork.)")
      .def(
          "__init__",
          [](DoubleDqn* learner, int inputs, int headings, int hidden, int features,
             const std::vector<double>& strides, double discount, bool double_q,
             bool clipped_double_q, bool clip_targets) {
            new (learner) DoubleDqn({inputs, headings, hidden, features},
                                    {discount, double_q, clipped_double_q, clip_targets}, strides);
          },
          nb::arg("inputs"), nb::arg("headings"), nb::arg("hidden"), nb::arg("features"),
          nb::arg("strides"), nb::kw_only(), nb::arg("discount"), nb::arg("double_q"),
          nb::arg("clipped_double_q"), nb::arg("clip_targets"))
      .def("step", &step, nb::arg("weights"), nb::arg("batch"), nb::arg("rates"), nb::kw_only(),
           nb::arg("threads"),
           R"(Performs a gradient step, and moves the other networks towards the online one.

Changes all of `weights` in place. Returns Q(s, a), the targets, and these before bounds and
clipping, [B] each.)");
}

}  // namespace rtg::bindings
