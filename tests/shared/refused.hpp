#pragma once
// What wrong input is refused with.

#include <gmock/gmock.h>

#include "base/errors.hpp"

/// The expression throws an InputError whose message contains these words. A macro, so that a failure names the test's line.
#define EXPECT_REFUSED(expression, words)  \
  EXPECT_THAT([&] { (void)(expression); }, \
              ::testing::ThrowsMessage<::driftwright::InputError>(::testing::HasSubstr(words)))
