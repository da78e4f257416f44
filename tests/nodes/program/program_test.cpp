#include "nodes/program/program.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace rtg::program {
namespace {

TEST(ParseNumber, ReadsWholeNumbersFromZeroOn) {
  EXPECT_EQ(parse_number("0", "NUMBER"), 0);
  EXPECT_EQ(parse_number("2147483647", "NUMBER"), 2147483647);
}

TEST(ParseNumber, RefusesEverythingElse) {
  for (const char* word : {"", " ", "-1", "+1", "1x", "1 ", "1.5", "1e3", "0x10", "2147483648"})
    try {
      parse_number(word, "NUMBER");
      ADD_FAILURE() << '\'' << word << "' was read";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(),
                "NUMBER '" + std::string(word) + "'; legal: a whole number from 0 on");
    }
}

}  // namespace
}  // namespace rtg::program
