#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "nodes/config/config.hpp"
#include "nodes/config/description.hpp"
#include "nodes/config/method.hpp"
#include "nodes/config/suggestion.hpp"
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

std::string suggestion(const std::string& word, const std::vector<std::string>& words) {
  return config::suggestion(word, words);
}

template <class Section>
void bind_section(nb::module_& module, const char* name, const char* doc) {
  nb::class_<Section> bound(module, name, doc);
  bind_fields(bound);
}

}  // namespace

void bind_config(nb::module_& module) {
  module.attr("METHODS") = names_of(config::kMethods);
  nb::exception<config::ConfigError>(module, "ConfigError", PyExc_ValueError).attr("__doc__") =
      "A mistake in the configuration; the text gives file:line, the key and the legal values.";
  module.def("suggestion", &suggestion, nb::arg("word"), nb::arg("words"),
             "Asks whether the most similar of `words` was meant by `word`; empty if none is.");
  bind_section<PhysicsConfig>(
      module, "PhysicsConfig",
      "The section `physics`. The physics that reverse solver and simulators share.");
  bind_section<forward::ForwardConfig>(
      module, "ForwardConfig", "The section `forward`. The simulator of the true dynamics.");
  bind_section<reverse::ReverseConfig>(module, "ReverseConfig",
                                       "The section `reverse`. The reverse solver.");
  bind_section<search::SearchConfig>(
      module, "SearchConfig", "The section `search`. The beam search and the stored data set.");
  bind_section<config::TrainConfig>(module, "TrainConfig", "The section `train`. The learner.");
  bind_section<config::RunConfig>(module, "RunConfig",
                                  "The section `run`. Method, seed, processes and bus of a run.");
  nb::class_<config::Config>(module, "Config", "The checked configuration of a run.")
      .def_static("from_file", &from_file, nb::arg("file"), nb::arg("overrides") = Overrides{},
                  "Loads a YAML file. `overrides`: each \"section.key=value\". Raises ConfigError.")
      .def_static("from_text", &from_text, nb::arg("text"), nb::arg("name") = "text",
                  nb::arg("overrides") = Overrides{}, R"(Loads a YAML text. Raises ConfigError.

Error messages use `name` as the name of the file. Paths in the text are relative to it.)")
      .def_ro("task", &config::Config::task, "The task.")
      .def_ro("physics", &config::Config::physics, "The section `physics`.")
      .def_ro("forward", &config::Config::forward, "The section `forward`.")
      .def_prop_ro(
          "has_built_in_engine",
          [](const config::Config& config) { return config.forward.is_built_in(); },
          "Whether the core has the forward simulator; else Python brings it along.")
      .def_ro("reverse", &config::Config::reverse, "The section `reverse`.")
      .def_ro("search", &config::Config::search, "The section `search`.")
      .def_ro("train", &config::Config::train, "The section `train`.")
      .def_ro("run", &config::Config::run, "The section `run`.")
      .def_prop_ro("learner_discount", &config::Config::learner_discount,
                   "Discount of the learner: `train.discount`, or that of the task if it is 0.")
      .def_prop_ro(
          "evaluation_jitter", &config::Config::evaluation_jitter,
          "Largest displacement of objects in x and y at the start of an evaluation episode [m].")
      .def_prop_ro("training_jitter", &config::Config::training_jitter,
                   "The same for episodes of training [m].")
      .def_prop_ro("heavy_bodies", &config::heavy_bodies,
                   "In words, the loose bodies that the robot pushes by less than half a stride.")
      .def_prop_ro("description", &config::description, "The configuration in human-readable text.")
      .def_prop_ro("yaml", &config::canonical_yaml,
                   "The canonical YAML text; loading it gives an equal configuration.")
      .def_prop_ro("json", &config::config_json, "The values as JSON.")
      .def("__reduce__", [](const config::Config& config) {
        return nb::make_tuple(nb::module_::import_("rtg.pickling").attr("config_of"),
                              nb::make_tuple(canonical_yaml(config)));
      });
}

}  // namespace rtg::bindings
