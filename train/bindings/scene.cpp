#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <utility>
#include <vector>

#include "core/tasks/task.hpp"
#include "train/bindings/bindings.hpp"
#include "train/bindings/vertices.hpp"

namespace rtg::bindings {

namespace nb = nanobind;

namespace {

std::vector<std::pair<Vertices, double>> parts(const Body& body) {
  std::vector<std::pair<Vertices, double>> out;
  for (const Part& part : body.shape.parts())
    out.emplace_back(vertices_of(part.core.vertices), part.radius);
  return out;
}

const char* type_of(const Joint& joint) {
  constexpr std::array kTypes{"revolute", "prismatic", "fixed"};
  return kTypes[static_cast<std::size_t>(joint.type)];
}

}  // namespace

void bind_scene(nb::module_& module) {
  nb::class_<Body>(module, "Body", "A rigid body, in units of the core; see rtg.engines.Body.")
      .def_ro("name", &Body::name, "The name of the body.")
      .def_ro("kind", &Body::kind, "The class that goals refer to.")
      .def_prop_ro("parts", &parts, "The convex parts: vertices [n, 2] and the radius around them.")
      .def_prop_ro(
          "mass", [](const Body& body) { return mass_of(body).mass; }, "The mass.")
      .def_prop_ro(
          "moment", [](const Body& body) { return mass_of(body).moment; },
          "The moment of inertia about the centre of mass.")
      .def_ro("friction", &Body::friction, "The coefficient of friction; a pair uses √(μ₁μ₂).")
      .def_ro("fixed", &Body::fixed, "Whether the body never moves.");
  nb::class_<Joint>(module, "Joint", "A joint, in units of the core; see rtg.engines.Joint.")
      .def_prop_ro("type", &type_of, "\"revolute\", \"prismatic\" or \"fixed\".")
      .def_ro("parent", &Joint::parent, "The index of the parent.")
      .def_ro("child", &Joint::child, "The index of the child.")
      .def_ro("on_parent", &Joint::on_parent, "The point on the parent, in its frame. [2]")
      .def_ro("on_child", &Joint::on_child, "The point on the child, in its frame. [2]")
      .def_ro("axis", &Joint::axis,
              "The axis of a prismatic joint, in the frame of the parent. [2]")
      .def_ro("angle", &Joint::angle, "The child's angle to its parent, unless it is revolute.")
      .def_ro("lower", &Joint::lower, "The lower limit of the joint's value.")
      .def_ro("upper", &Joint::upper, "The upper limit of the joint's value.");
}

}  // namespace rtg::bindings
