#pragma once

#include <cstdint>
#include <rtg_msgs/wire_fields.hpp>
#include <string>
#include <vector>

namespace rtg::testing {

/// Fills every field of a message: counts with `n`, numbers with 1, 2, 3, ..., texts likewise.
struct Fill {
  std::int32_t n = 3;
  int next = 1;

  template <class T>
  void scalar(const char*, T& x) {
    x = static_cast<T>(next++);
  }
  void count(const char*, std::int32_t& x) { x = n; }
  template <class T>
  void array(const char*, std::vector<T>& values, std::int32_t size) {
    values.resize(static_cast<std::size_t>(size));
    for (T& x : values) scalar("", x);
  }
  void text(const char*, std::string& s) { s = "text " + std::to_string(next++); }
  void texts(const char*, std::vector<std::string>& values, std::int32_t size) {
    values.resize(static_cast<std::size_t>(size));
    for (std::string& s : values) text("", s);
  }
};

template <class Msg>
Msg filled(std::int32_t n = 3) {
  Msg msg{};
  Fill fill{n};
  fields(fill, msg);
  return msg;
}

}  // namespace rtg::testing
