#include "core/energy/step_energy.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <tuple>
#include <vector>

#include "core/energy/implicit_step.hpp"
#include "nodes/config/config.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg::bindings {
namespace {

/// Normal forces of all contacts [contacts].
using ForceArray = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

nb::ndarray<nb::numpy, double> array_of(const VectorXd& v) {
  const auto count = static_cast<std::size_t>(v.size());
  OwnedArray<double> out(count);
  std::copy_n(v.data(), count, out.data.get());
  return out.release({count});
}

/// The step energy of a task, with arrays in the place of Eigen's vectors.
class TaskEnergy {
 public:
  explicit TaskEnergy(const config::Config& config)
      : config_(config), energy_(config.task.scene, config.physics, config.task.push) {}

  const config::Config& config() const { return config_; }

  std::vector<std::tuple<int, int, double>> contacts() const {
    std::vector<std::tuple<int, int, double>> out;
    for (const energy::Contact& c : energy_.contacts())
      out.emplace_back(c.body, c.other, c.friction);
    return out;
  }

  nb::ndarray<nb::numpy, double> gaps(const StateArray& state) const {
    const VectorXd p = poses(state);
    VectorXd gaps(static_cast<Eigen::Index>(energy_.contacts().size()));
    for (Eigen::Index k = 0; k < gaps.size(); ++k)
      gaps[k] = energy_.gap_value(energy_.contacts()[static_cast<std::size_t>(k)], p);
    return array_of(gaps);
  }

  nb::ndarray<nb::numpy, double> forces(const StateArray& state) const {
    return array_of(energy_.forces(poses(state)));
  }

  double value(const StateArray& next, const StateArray& now,
               const std::optional<ForceArray>& previous_forces) const {
    const VectorXd p = poses(now), loads = given_or_at(previous_forces, p);
    return energy_.value(poses(next), {p, loads});
  }

  nb::tuple model(const StateArray& next, const StateArray& now,
                  const std::optional<ForceArray>& previous_forces) const {
    const VectorXd p = poses(now), loads = given_or_at(previous_forces, p);
    const energy::StepEnergy::Model model = energy_.model(poses(next), {p, loads});
    const auto size = static_cast<std::size_t>(model.gradient.size());
    OwnedArray<double> hessian(size * size);
    std::copy_n(model.hessian.data(), size * size, hessian.data.get());
    return nb::make_tuple(array_of(model.gradient), hessian.release({size, size}));
  }

 private:
  VectorXd poses(const StateArray& state) const {
    return energy::stacked(only_state(state, config_.task.scene.size()));
  }

  VectorXd given_or_at(const std::optional<ForceArray>& forces, const VectorXd& p) const {
    if (!forces) return energy_.forces(p);
    const std::size_t count = energy_.contacts().size();
    if (forces->shape(0) != count)
      throw nb::value_error((std::to_string(forces->shape(0)) +
                             " forces; legal: " + std::to_string(count) + ", one per contact")
                                .c_str());
    return Eigen::Map<const VectorXd>(forces->data(), static_cast<Eigen::Index>(count));
  }

  config::Config config_;
  energy::StepEnergy energy_;
};

}  // namespace

void bind_energy(nb::module_& module) {
  nb::class_<TaskEnergy>(module, "StepEnergy",
                         R"(The step energy of a task, in units of the core; see rtg.energy.

States are [1, bodies, 3], forces [C]. Raises ValueError for arrays that do not fit the task.)")
      .def(nb::init<const config::Config&>(), nb::arg("config"))
      .def("__reduce__",
           [](const TaskEnergy& energy) {
             return nb::make_tuple(nb::type<TaskEnergy>(), nb::make_tuple(energy.config()));
           })
      .def_prop_ro("contacts", &TaskEnergy::contacts,
                   "Body, other body and coefficient of friction of each contact. [C]")
      .def("gaps", &TaskEnergy::gaps, nb::arg("state"), "Returns the gap of each contact. [C]")
      .def("forces", &TaskEnergy::forces, nb::arg("state"),
           "Returns the normal force of each contact. [C]")
      .def("value", &TaskEnergy::value, nb::arg("next"), nb::arg("now"),
           nb::arg("previous_forces").none(),
           "Returns the energy; infinity where a gap is not positive.")
      .def("model", &TaskEnergy::model, nb::arg("next"), nb::arg("now"),
           nb::arg("previous_forces").none(),
           "Returns gradient and Hessian, [3 movable] and [3 movable, 3 movable].");
}

}  // namespace rtg::bindings
