#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <optional>
#include <string>

#include "core/learn/heading_network.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg::bindings {
namespace {

using learn::HeadingNetwork;
using Floats = nb::ndarray<const float, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using StateRows = nb::ndarray<const float, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;

std::size_t weight_count(const HeadingNetwork& network) {
  return static_cast<std::size_t>(weight_count(network.sizes()));
}

[[noreturn]] void refuse(const std::string& what) { throw nb::value_error(what.c_str()); }

void check_weights(const HeadingNetwork& network, const Floats& weights) {
  if (weights.shape(0) != weight_count(network))
    refuse(std::to_string(weights.shape(0)) +
           " weights; legal: " + std::to_string(weight_count(network)));
}

void check(const HeadingNetwork& network, const Floats& weights, const StateRows& states) {
  check_weights(network, weights);
  const std::size_t inputs = static_cast<std::size_t>(network.sizes().inputs);
  if (states.shape(1) != inputs)
    refuse("states of " + std::to_string(states.shape(1)) +
           " numbers; legal: " + std::to_string(inputs));
}

/// The rows of a numpy array as columns.
HeadingNetwork::States columns(const StateRows& rows) {
  return {rows.data(), static_cast<Eigen::Index>(rows.shape(1)),
          static_cast<Eigen::Index>(rows.shape(0))};
}

/// A copy of the numbers of a matrix, column by column.
template <class Matrix>
nb::ndarray<nb::numpy, float> copied(const Matrix& matrix,
                                     std::initializer_list<std::size_t> shape) {
  OwnedArray<float> out(static_cast<std::size_t>(matrix.size()));
  std::copy_n(matrix.data(), matrix.size(), out.data.get());
  return out.release(shape);
}

nb::ndarray<nb::numpy, float> values(HeadingNetwork& network, const Floats& weights,
                                     const StateRows& states) {
  check(network, weights, states);
  const auto headings = static_cast<std::size_t>(network.sizes().headings);
  const auto compute = [&]() -> auto& {
    const nb::gil_scoped_release release;
    return network.values(weights.data(), columns(states));
  };
  return copied(compute(), {states.shape(0), headings});
}

nb::ndarray<nb::numpy, float> values_at(HeadingNetwork& network, const Floats& weights,
                                        const StateRows& states, const ActionArray& headings) {
  check(network, weights, states);
  check_headings(headings, states.shape(0), network.sizes().headings, "heading");
  const HeadingNetwork::Headings chosen(headings.data(), headings.shape(0));
  const auto compute = [&]() -> auto& {
    const nb::gil_scoped_release release;
    return network.values_at(weights.data(), columns(states), chosen);
  };
  return copied(compute(), {chosen.size()});
}

nb::ndarray<nb::numpy, float> gradient(HeadingNetwork& network, const Floats& weights,
                                       const Floats& of_q) {
  check_weights(network, weights);
  const auto count = static_cast<Eigen::Index>(of_q.shape(0));
  if (!network.last_call())
    refuse("a gradient without values; legal: values_at() before, no other call between");
  if (count != network.last_call()->batch)
    refuse("a gradient for " + std::to_string(count) + " values; legal: " +
           std::to_string(network.last_call()->batch) + ", those of the last call");
  const auto compute = [&]() -> auto& {
    const nb::gil_scoped_release release;
    return network.gradient(weights.data(), {of_q.data(), count});
  };
  return copied(compute(), {weight_count(network)});
}

}  // namespace

void bind_network(nb::module_& module) {
  nb::class_<HeadingNetwork>(module, "HeadingNetwork")
      .def(
          "__init__",
          [](HeadingNetwork* network, int inputs, int headings, int hidden, int features) {
            new (network) HeadingNetwork({inputs, headings, hidden, features});
          },
          nb::arg("inputs"), nb::arg("headings"), nb::arg("hidden"), nb::arg("features"))
      .def("values", &values, nb::arg("weights"), nb::arg("states"))
      .def("values_at", &values_at, nb::arg("weights"), nb::arg("states"), nb::arg("headings"))
      .def_prop_ro("last_call",
                   [](const HeadingNetwork& network) -> std::optional<long> {
                     const auto& call = network.last_call();
                     return call ? std::optional(call->number) : std::nullopt;
                   })
      .def("gradient", &gradient, nb::arg("weights"), nb::arg("of_q"));
}

}  // namespace rtg::bindings
