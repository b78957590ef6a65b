#include "compensation/sensors/complete_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::complete_rows_test {
namespace {

TEST(CompleteRows, StacksRecordsAndLeavesOutRowsWithAGap) {
  const std::vector<Record> records = {
      {.source = "a", .time_s = {0, 1, 2}, .channels = {{"x", "K", {1, 2, NAN}}, {"y", "um", {10, NAN, 30}}}},
      {.source = "b", .time_s = {0, 1}, .channels = {{"y", "um", {40, 50}}, {"x", "K", {4, 5}}}}};
  const CompleteRows rows = complete_rows(records, {"y", "x"});
  const Eigen::MatrixXd expected{{10, 1}, {40, 4}, {50, 5}};  // by eye: rows 1 and 2 of "a" have a gap each
  EXPECT_EQ(rows.values, expected);
  EXPECT_EQ(rows.n_left_out, 2);
  EXPECT_EQ(rows.units, (std::vector<std::string>{"um", "K"}));
}

TEST(CompleteRows, RefusesNoRecordMissingChannelAndMixedUnits) {
  const Record kelvin{.source = "a.csv", .time_s = {0, 1}, .channels = {{"x", "K", {1, 2}}}};
  const Record celsius{.source = "b.csv", .time_s = {0, 1}, .channels = {{"x", "degC", {1, 2}}}};
  EXPECT_REFUSED(complete_rows({}, {"x"}), "no record");
  EXPECT_REFUSED(complete_rows(std::vector{kelvin}, {"z"}), "no channel 'z'");
  EXPECT_REFUSED(complete_rows(std::vector{kelvin, celsius}, {"x"}), "in K in a.csv but in degC in b.csv");
}

}  // namespace
}  // namespace driftwright::compensation::complete_rows_test
