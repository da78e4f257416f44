#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <utility>
#include <vector>

#include "core/tasks/task.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg::bindings {
namespace {

using Vertices = nb::ndarray<nb::numpy, double>;

Vertices point(const Vector2d& at) {
  OwnedArray<double> out(2);
  out.data[0] = at.x();
  out.data[1] = at.y();
  return out.release({2});
}

std::vector<std::pair<Vertices, double>> parts(const Body& body) {
  std::vector<std::pair<Vertices, double>> out;
  for (const Part& part : body.shape.parts()) {
    OwnedArray<double> vertices(2 * part.core.vertices.size());
    double* next = vertices.data.get();
    for (const Vector2d& v : part.core.vertices) {
      *next++ = v.x();
      *next++ = v.y();
    }
    out.emplace_back(vertices.release({part.core.vertices.size(), 2}), part.radius);
  }
  return out;
}

const char* type_of(const Joint& joint) {
  constexpr std::array kTypes{"revolute", "prismatic", "fixed"};
  return kTypes[static_cast<std::size_t>(joint.type)];
}

}  // namespace

void bind_scene(nb::module_& module) {
  nb::class_<Body>(module, "Body", "A rigid body, in units of the core; see rtg.engines.Body.")
      .def_ro("name", &Body::name)
      .def_ro("kind", &Body::kind)
      .def_prop_ro("parts", &parts, nb::rv_policy::move)
      .def_prop_ro("mass", [](const Body& body) { return mass_of(body).mass; })
      .def_prop_ro("moment", [](const Body& body) { return mass_of(body).moment; })
      .def_ro("friction", &Body::friction)
      .def_ro("fixed", &Body::fixed);
  nb::class_<Joint>(module, "Joint", "A joint, in units of the core; see rtg.engines.Joint.")
      .def_prop_ro("type", &type_of)
      .def_ro("parent", &Joint::parent)
      .def_ro("child", &Joint::child)
      .def_prop_ro(
          "on_parent", [](const Joint& joint) { return point(joint.on_parent); },
          nb::rv_policy::move)
      .def_prop_ro(
          "on_child", [](const Joint& joint) { return point(joint.on_child); }, nb::rv_policy::move)
      .def_prop_ro(
          "axis", [](const Joint& joint) { return point(joint.axis); }, nb::rv_policy::move)
      .def_ro("angle", &Joint::angle)
      .def_ro("lower", &Joint::lower)
      .def_ro("upper", &Joint::upper);
}

}  // namespace rtg::bindings
