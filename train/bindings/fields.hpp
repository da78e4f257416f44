#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace rtg::bindings {

/// Visitor for Section::visit() that binds each field as a read-only Python property of the same
/// name. A choice becomes the name of its value. The `names` of a choice must have static storage
/// duration, because the property keeps a reference to them.
template <class Section>
class FieldBinder {
 public:
  FieldBinder(nanobind::class_<Section>& bound, const Section& like) : bound_(bound), like_(like) {}

  void number(const char* name, const double& at, double, double, const char* doc) {
    bind(name, at, doc);
  }
  void length(const char* name, const double& at, double, double, const char* doc) {
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
        [offset, &names](const Section& config) {
          return std::string(names[static_cast<std::size_t>(field<Enum>(config, offset))]);
        },
        doc);
  }

 private:
  template <class Value>
  static const Value& field(const Section& config, std::size_t offset) {
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
        name, [offset](const Section& config) { return field<Value>(config, offset); }, doc);
  }

  nanobind::class_<Section>& bound_;
  const Section& like_;
};

/// Returns the names of the values of an enumeration as a Python tuple, in the order of the values.
template <class Names>
nanobind::tuple names_of(const Names& names) {
  nanobind::list found;
  for (const std::string_view name : names) found.append(std::string(name));
  return nanobind::tuple(found);
}

/// Binds the fields that Section::visit() shows.
template <class Section>
void bind_fields(nanobind::class_<Section>& bound) {
  Section like;
  FieldBinder<Section> binder(bound, like);
  like.visit(binder);
}

}  // namespace rtg::bindings
