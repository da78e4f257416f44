#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace rtg::testing {

/// An empty folder of the running test's own, as tests run side by side; it is removed in the end.
struct Folder {
  std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / name();

  Folder() { std::filesystem::create_directory(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

 private:
  static std::string name() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name();
    std::ranges::replace(name, '/', '.');  // of tests with parameters
    return name;
  }
};

}  // namespace rtg::testing
