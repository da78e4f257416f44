#pragma once

#include <charconv>
#include <string_view>
#include <system_error>

namespace rtg::bench {

/// Whether the whole text is a number in [least, most]; if so, it is written to `out`.
template <class Number>
bool read_number(std::string_view text, Number least, Number most, Number& out) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return false;
  if (!(number >= least && number <= most)) return false;
  out = number;
  return true;
}

/// Visitor of a configuration that sets the number called `name`.
struct Setter {
  std::string_view name, value;
  bool done = false;

  void number(std::string_view key, double& field, double least, double most, const char*) {
    if (key == name) done = read_number(value, least, most, field);
  }
  void integer(std::string_view key, int& field, int least, int most, const char*) {
    if (key == name) done = read_number(value, least, most, field);
  }
  void flag(std::string_view, bool&, const char*) {}
  template <class Enum, class Names>
  void choice(std::string_view, Enum&, const Names&, const char*) {}
};

}  // namespace rtg::bench
