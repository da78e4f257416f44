#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "nodes/config/description.hpp"
#include "nodes/config/config.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"
#include "train/bindings/fields.hpp"

namespace rtg {
namespace {

using Overrides = std::vector<std::string>;

Config from_file(const std::filesystem::path& file, const Overrides& overrides) {
  return load_config(file, overrides);
}

Config from_text(const std::string& text, const std::string& name, const Overrides& overrides) {
  return parse_config(text, name, overrides);
}

}  // namespace

void bind_config(nb::module_& module) {
  nb::exception<ConfigError>(module, "ConfigError", PyExc_ValueError);
  bind_fields<PhysicsConfig>(module, "PhysicsConfig");
  bind_fields<ReverseConfig>(module, "ReverseConfig");
  bind_fields<SearchConfig>(module, "SearchConfig");
  bind_fields<TrainConfig>(module, "TrainConfig");
  bind_fields<RunConfig>(module, "RunConfig");
  nb::class_<Config>(module, "Config")
      .def_static("from_file", &from_file, nb::arg("file"), nb::arg("overrides") = Overrides{})
      .def_static("from_text", &from_text, nb::arg("text"), nb::arg("name") = "text",
                  nb::arg("overrides") = Overrides{})
      .def_ro("task", &Config::task)
      .def_ro("physics", &Config::physics)
      .def_ro("reverse", &Config::reverse)
      .def_ro("search", &Config::search)
      .def_ro("train", &Config::train)
      .def_ro("run", &Config::run)
      .def_prop_ro("description", &description)
      .def_prop_ro("yaml", &canonical_yaml)
      .def_prop_ro("json", &config_json);
}

}  // namespace rtg
