#include "base/option_quantity.hpp"

#include <gmock/gmock.h>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::option_quantity_test {
namespace {

using ::testing::HasSubstr, ::testing::ThrowsMessage;

TEST(OptionQuantity, ReadsSharesAndQuantities) {
  EXPECT_DOUBLE_EQ(option_quantity("--margin", "20 %", "1", 0.0, 0.95), 0.2);
  EXPECT_DOUBLE_EQ(option_quantity("--margin", "0.2", "1", 0.0, 0.95), 0.2);
  EXPECT_DOUBLE_EQ(option_quantity("--lag", "2 min", "s", 0.0, 3600.0), 120.0);
}

TEST(OptionQuantity, SaysWhatIsAllowedInTheUnitOfTheOption) {
  const auto margin = [](const std::string& text) {
    return [=] { (void)option_quantity("--margin", text, "1", 0.0, 0.95); };
  };
  EXPECT_THAT(margin("110 %"), ThrowsMessage<InputError>(HasSubstr("--margin '110 %': 0 % to 95 % is allowed")));
  EXPECT_THAT(margin("nan"), ThrowsMessage<InputError>(HasSubstr("--margin 'nan'")));
  EXPECT_THAT(margin("5 um"), ThrowsMessage<InputError>(HasSubstr("wrong unit 'um': the value must be a number or a share, "
                                                                  "such as 20 %")));
  EXPECT_REFUSED(option_quantity("--lag", "2 h", "s", 0.0, 3600.0), "--lag '2 h': 0 s to 3600 s is allowed");
}

}  // namespace
}  // namespace driftwright::option_quantity_test
