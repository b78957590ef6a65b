#pragma once
// What wrong input is refused with.

#include <gmock/gmock.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "base/errors.hpp"

namespace driftwright::fixtures {

/// Matches an InputError whose message contains all these words.
inline auto refused_with(std::initializer_list<std::string> words) {
  std::vector<::testing::Matcher<std::string>> all;
  for (const std::string& w : words) all.emplace_back(::testing::HasSubstr(w));
  return ::testing::ThrowsMessage<InputError>(::testing::AllOfArray(all));
}

}  // namespace driftwright::fixtures

/// The expression throws an InputError whose message contains the words that follow. A macro, so that a failure names the
/// test's line.
#define EXPECT_REFUSED(expression, ...) \
  EXPECT_THAT([&] { (void)(expression); }, ::driftwright::fixtures::refused_with({__VA_ARGS__}))
