#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <cstddef>
#include <string>

namespace rtg {

/// Binds the fields that Config::visit() lists as read-only properties of the same names. A choice
/// is the text of the configuration, whose list of names lasts for ever.
template <class Config>
class FieldBinder {
 public:
  FieldBinder(nanobind::class_<Config>& bound, const Config& like) : bound_(bound), like_(like) {}

  void number(const char* name, const double& at, double, double, const char* doc) {
    bind(name, at, doc);
  }
  void integer(const char* name, const int& at, int, int, const char* doc) { bind(name, at, doc); }
  void flag(const char* name, const bool& at, const char* doc) { bind(name, at, doc); }
  void text(const char* name, const std::string& at, const char* doc) { bind(name, at, doc); }

  template <class Enum, class Names>
  void choice(const char* name, const Enum& at, const Names& names, const char* doc) {
    const std::size_t offset = offset_of(at);
    bound_.def_prop_ro(
        name,
        [offset, &names](const Config& config) {
          return std::string(names[static_cast<std::size_t>(field<Enum>(config, offset))]);
        },
        doc);
  }

 private:
  template <class Value>
  static const Value& field(const Config& config, std::size_t offset) {
    return *reinterpret_cast<const Value*>(reinterpret_cast<const char*>(&config) + offset);
  }

  template <class Value>
  std::size_t offset_of(const Value& at) const {
    return static_cast<std::size_t>(reinterpret_cast<const char*>(&at) -
                                    reinterpret_cast<const char*>(&like_));
  }

  template <class Value>
  void bind(const char* name, const Value& at, const char* doc) {
    const std::size_t offset = offset_of(at);
    bound_.def_prop_ro(
        name, [offset](const Config& config) { return field<Value>(config, offset); }, doc);
  }

  nanobind::class_<Config>& bound_;
  const Config& like_;
};

template <class Config>
void bind_fields(nanobind::module_& module, const char* name) {
  nanobind::class_<Config> bound(module, name);
  Config like;
  FieldBinder<Config> binder(bound, like);
  like.visit(binder);
}

}  // namespace rtg
