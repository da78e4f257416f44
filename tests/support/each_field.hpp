#pragma once

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

namespace rtg::testing {

/// Another value of each field of a configuration; of choices the number of the other one.
using OtherValues = std::map<std::string, double>;

/// Gives the field `name` the value `value`, and lists all fields.
struct FieldChange {
  std::string name;
  double value = 0.0;
  std::set<std::string> seen = {};

  void number(const char* field, double& at, double least, double most, const char*) {
    if (!is_wanted(field)) return;
    EXPECT_TRUE(least <= value && value <= most && value != at) << field;
    at = value;
  }
  void length(const char* field, double& at, double least, double most, const char* doc) {
    number(field, at, least, most, doc);
  }
  void integer(const char* field, int& at, int least, int most, const char*) {
    if (!is_wanted(field)) return;
    EXPECT_TRUE(least <= value && value <= most && value != at) << field;
    at = static_cast<int>(value);
  }
  void flag(const char* field, bool& at, const char*) {
    if (is_wanted(field)) at = !at;
  }
  template <class Enum, class Names>
  void choice(const char* field, Enum& at, const Names&, const char*) {
    if (is_wanted(field)) at = static_cast<Enum>(static_cast<int>(value));
  }

 private:
  bool is_wanted(const char* field) {
    seen.insert(field);
    return field == name;
  }
};

/// Lists the values of all fields.
struct FieldValues {
  std::map<std::string, double> found = {};

  void number(const char* field, double at, double, double, const char*) { found[field] = at; }
  void length(const char* field, double at, double, double, const char*) { found[field] = at; }
  void integer(const char* field, int at, int, int, const char*) { found[field] = at; }
  void flag(const char* field, bool at, const char*) { found[field] = at; }
  template <class Enum, class Names>
  void choice(const char* field, Enum at, const Names&, const char*) {
    found[field] = static_cast<int>(at);
  }
};

/// Returns the fields in which `a` and `b` differ.
template <class Section>
std::set<std::string> differences(Section a, Section b) {
  FieldValues of_a, of_b;
  a.visit(of_a);
  b.visit(of_b);
  std::set<std::string> differ;
  for (const auto& [name, value] : of_a.found)
    if (of_b.found.at(name) != value) differ.insert(name);
  return differ;
}

/// Expects that each field of `config`, with its value in `others`, changes what `result` makes of
/// the configuration, and no other field, and that `others` has all fields but `left_out`.
template <class Section, class Result>
void expect_each_field_matters(const Section& config, const OtherValues& others,
                               const std::set<std::string>& left_out, Result result) {
  const auto usual = result(config);
  FieldChange none{""};
  Section all = config;
  all.visit(none);
  std::set<std::string> tried = left_out;
  for (const auto& [name, value] : others) {
    tried.insert(name);
    Section changed = config;
    FieldChange change{name, value};
    changed.visit(change);
    EXPECT_EQ(differences(config, changed), std::set{name});
    EXPECT_FALSE(result(changed) == usual) << name << " does nothing";
  }
  EXPECT_EQ(tried, none.seen);
}

}  // namespace rtg::testing
