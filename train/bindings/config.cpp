#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "nodes/config/rtg_config.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg {
namespace {

using Overrides = std::vector<std::string>;

RtgConfig from_file(const std::filesystem::path& file, const Overrides& overrides) {
  return load_config(file, overrides);
}

RtgConfig from_text(const std::string& text, const std::string& name, const Overrides& overrides) {
  return parse_config(text, name, overrides);
}

}  // namespace

void bind_config(nb::module_& module) {
  nb::exception<ConfigError>(module, "ConfigError", PyExc_ValueError);
  nb::class_<RtgConfig>(module, "Config")
      .def_static("from_file", &from_file, nb::arg("file"), nb::arg("overrides") = Overrides{})
      .def_static("from_text", &from_text, nb::arg("text"), nb::arg("name") = "text",
                  nb::arg("overrides") = Overrides{})
      .def_ro("task", &RtgConfig::task)
      .def_prop_ro("yaml", &canonical_yaml)
      .def_prop_ro("json", &config_json);
}

}  // namespace rtg
