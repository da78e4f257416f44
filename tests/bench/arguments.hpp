#pragma once

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "core/reverse/problem/reverse_config.hpp"
#include "core/world/physics_config.hpp"

namespace rtg::bench {

/// Returns whether the whole text is a number in [least, most]; if so, it is written to `out`.
template <class Number>
bool read_number(std::string_view text, Number least, Number most, Number& out) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return false;
  if (!(number >= least && number <= most)) return false;
  out = number;
  return true;
}

/// Visitor of a configuration that sets the number, the flag or the choice called `name`.
struct Setter {
  std::string_view name, value;
  bool known = false, done = false;

  void number(std::string_view key, double& field, double least, double most, const char*) {
    if (is(key)) done = read_number(value, least, most, field);
  }
  void integer(std::string_view key, int& field, int least, int most, const char*) {
    if (is(key)) done = read_number(value, least, most, field);
  }
  void flag(std::string_view key, bool& field, const char*) {
    if (!is(key) || (value != "true" && value != "false")) return;
    field = value == "true";
    done = true;
  }
  template <class Enum, class Names>
  void choice(std::string_view key, Enum& field, const Names& names, const char*) {
    const auto found = std::ranges::find(names, value);
    if (!is(key) || key == "preset" || found == names.end()) return;
    field = static_cast<Enum>(found - names.begin());
    done = true;
  }

  bool is(std::string_view key) {
    known = known || key == name;
    return key == name;
  }
};

/// The solver's settings.
struct SolverOptions {
  reverse::ReverseConfig reverse;
  PhysicsConfig physics;
};

/// Applies `--preset default|paper` or `--set NAME VALUE` at the beginning of `words`. NAME is a
/// setting of the section reverse or, if that has none of this name, of physics. A preset stands
/// above what was set before it. Returns how many words it took: 0 if they are neither or wrong.
inline std::size_t apply(std::span<char* const> words, SolverOptions& options) {
  const std::string_view flag = words[0];
  if (flag == "--preset" && words.size() >= 2) {
    const auto preset = std::ranges::find(reverse::kReversePresets, std::string_view(words[1]));
    if (preset == reverse::kReversePresets.end()) return 0;
    options.reverse = reverse_preset(
        static_cast<reverse::ReversePreset>(preset - reverse::kReversePresets.begin()));
    return 2;
  }
  if (flag != "--set" || words.size() < 3) return 0;
  Setter setter{words[1], words[2]};
  options.reverse.visit(setter);
  if (!setter.known) options.physics.visit(setter);
  return setter.done ? 3 : 0;
}

/// Reads all `words` by apply(words, Options&), which returns how many words it took. Says on
/// stderr which one is wrong and returns nothing then.
template <class Options>
std::optional<Options> read_options(const char* program, std::span<char* const> words) {
  Options options;
  while (!words.empty()) {
    const std::size_t taken = apply(words, options);
    if (taken == 0) {
      std::fprintf(stderr, "%s: %s %s: no such argument, or its value is wrong\n", program,
                   words[0], words.size() > 1 ? words[1] : "");
      return std::nullopt;
    }
    words = words.subspan(taken);
  }
  return options;
}

}  // namespace rtg::bench
