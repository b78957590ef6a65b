// Messages that show a line of a file: short lines whole, long ones around the column.

#include "base/errors.hpp"

#include <gtest/gtest.h>

#include <string>

namespace driftwright::errors_test {
namespace {

std::string message(int column, const std::string& line) {
  return InputError({"a.yaml", 7, column, "", line}, "wrong").what();
}

TEST(InputErrors, AShortLineIsShownWholeWithACaretBelowTheColumn) {
  EXPECT_EQ(message(4, "ab cd"), "a.yaml:7:4: wrong\n    7 | ab cd\n      |    ^");
  EXPECT_EQ(message(1, std::string(160, 'x')), "a.yaml:7:1: wrong\n    7 | " + std::string(160, 'x') + "\n      | ^");
  EXPECT_EQ(message(9, "ab"), "a.yaml:7:9: wrong\n    7 | ab\n      |   ^");  // after its end
}

TEST(InputErrors, OfALongLineOnlyTheSurroundingsAreShown) {
  const std::string blank(103, ' ');
  EXPECT_EQ(message(5001, std::string(5000, 'x') + "Y" + std::string(500000, 'z')),
            "a.yaml:7:5001: wrong\n    7 | ..." + std::string(100, 'x') + "Y" + std::string(59, 'z') + "...\n      | " +
                blank + "^");
  EXPECT_EQ(message(5001, std::string(5000, 'x')),
            "a.yaml:7:5001: wrong\n    7 | ..." + std::string(100, 'x') + "\n      | " + blank + "^");
  EXPECT_EQ(message(3, "ab" + std::string(300, 'c')),
            "a.yaml:7:3: wrong\n    7 | ab" + std::string(158, 'c') + "...\n      |   ^");
}

TEST(InputErrors, LettersOfTwoBytesAreNotCutInHalf) {
  std::string line;
  for (int i = 0; i < 500; ++i) line += "\xC3\xA4";
  for (int column = 1; column <= 1001; ++column) {
    const std::string text = message(column, line);
    const std::size_t from = text.find(" | ") + 3, until = text.find('\n', from);
    const std::string shown = text.substr(from, until - from);
    ASSERT_EQ(shown.find_first_not_of("."), shown.find('\xC3')) << column;
    ASSERT_EQ(shown[shown.find_last_not_of(".")], '\xA4') << column;
  }
}

}  // namespace
}  // namespace driftwright::errors_test
