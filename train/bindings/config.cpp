#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "nodes/config/config.hpp"
#include "nodes/config/description.hpp"
#include "nodes/config/method.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"
#include "train/bindings/fields.hpp"

namespace rtg::bindings {
namespace {

using Overrides = std::vector<std::string>;

config::Config from_file(const std::filesystem::path& file, const Overrides& overrides) {
  return config::load_config(file, overrides);
}

config::Config from_text(const std::string& text, const std::string& name,
                         const Overrides& overrides) {
  return config::parse_config(text, name, overrides);
}

template <class Section>
void bind_section(nb::module_& module, const char* name) {
  nb::class_<Section> bound(module, name);
  bind_fields(bound);
}

}  // namespace

void bind_config(nb::module_& module) {
  module.attr("METHODS") = names_of(config::kMethods);
  nb::exception<config::ConfigError>(module, "ConfigError", PyExc_ValueError);
  bind_section<PhysicsConfig>(module, "PhysicsConfig");
  bind_section<forward::ForwardConfig>(module, "ForwardConfig");
  bind_section<reverse::ReverseConfig>(module, "ReverseConfig");
  bind_section<search::SearchConfig>(module, "SearchConfig");
  bind_section<config::TrainConfig>(module, "TrainConfig");
  bind_section<config::RunConfig>(module, "RunConfig");
  nb::class_<config::Config>(module, "Config")
      .def_static("from_file", &from_file, nb::arg("file"), nb::arg("overrides") = Overrides{})
      .def_static("from_text", &from_text, nb::arg("text"), nb::arg("name") = "text",
                  nb::arg("overrides") = Overrides{})
      .def_ro("task", &config::Config::task)
      .def_ro("physics", &config::Config::physics)
      .def_ro("forward", &config::Config::forward)
      .def_ro("reverse", &config::Config::reverse)
      .def_ro("search", &config::Config::search)
      .def_ro("train", &config::Config::train)
      .def_ro("run", &config::Config::run)
      .def_prop_ro("learner_discount", &config::Config::learner_discount)
      .def_prop_ro("evaluation_jitter", &config::Config::evaluation_jitter)
      .def_prop_ro("training_jitter", &config::Config::training_jitter)
      .def_prop_ro("description", &config::description)
      .def_prop_ro("yaml", &config::canonical_yaml)
      .def_prop_ro("json", &config::config_json)
      .def("__reduce__", [](const config::Config& config) {
        return nb::make_tuple(nb::module_::import_("rtg.pickling").attr("config_of"),
                              nb::make_tuple(canonical_yaml(config)));
      });
}

}  // namespace rtg::bindings
