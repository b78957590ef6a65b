#include "base/pattern.hpp"

#include <gtest/gtest.h>

namespace driftwright {
namespace {

TEST(Pattern, GivesWholeAndGroups) {
  const Pattern offset("^(.*[0-9])[ \t]*([-+])([0-9]{2}):?([0-9]{2})?$");
  const auto parts = offset.find("2024-03-01T10:00:00 +01");
  ASSERT_TRUE(parts);
  EXPECT_EQ(*parts, (std::vector<std::string>{"2024-03-01T10:00:00 +01", "2024-03-01T10:00:00", "+", "01", ""}));
  EXPECT_FALSE(offset.is_in("2024-03-01T10:00:00 CET"));
}

TEST(Pattern, OfManyCharactersNeedsNoStack) {
  const Pattern digit("[0-9]$");
  EXPECT_TRUE(digit.is_in(std::string(1'000'000, 'a') + "7"));
}

TEST(Pattern, ThatIsNoneIsRefused) {
  EXPECT_THROW(Pattern("("), std::exception);
}

}  // namespace
}  // namespace driftwright
