// Numbers that instruments write where they have no reading become missing and are said; hot bodies and steps stay.

#include "base/no_reading.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::no_reading_test {
namespace {

using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::IsEmpty;

Record record_of(const std::string& unit, std::vector<double> values) {
  Record record{.source = "r", .time_s = {}, .channels = {{"t", unit, std::move(values)}}};
  for (std::size_t i = 0; i < record.channels[0].values.size(); ++i) record.time_s.push_back(60.0 * static_cast<double>(i));
  return record;
}

/// Rows whose reading was taken out.
std::vector<std::size_t> taken_out(Record record) {
  (void)take_out_no_readings(record);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (std::isnan(record.channels[0].values[i])) rows.push_back(i);
  }
  return rows;
}

TEST(NoReading, AnOpenThermocoupleIsSaidWithRowsAndValue) {
  Record record = record_of("degC", {20.1, 20.2, 850, 850, 850, 20.4, 20.5});
  EXPECT_THAT(take_out_no_readings(record), ElementsAre(AllOf(HasSubstr("t_degC reads 850 degC in 3 rows from 2 to 4 min"),
                                                              HasSubstr("open or broken sensor"))));
  EXPECT_TRUE(std::isnan(record.channels[0].values[3]));
  EXPECT_EQ(record.channels[0].values[5], 20.4);
}

TEST(NoReading, MarksOfInstrumentsInTemperatures) {
  for (double mark : {-273.15, 850.0, 888.8, 9999.0, -9999.0, -3276.8, 3276.7, -127.0, 1372.0, -1e4}) {
    EXPECT_THAT(taken_out(record_of("degC", {20.1, 20.2, mark, mark, 20.4})), ElementsAre(2, 3)) << mark;
    EXPECT_THAT(taken_out(record_of("degC", {20.1, mark, 20.4})), ElementsAre(1)) << mark;
    EXPECT_THAT(taken_out(record_of("degC", {20.1, 20.2, mark, mark, mark})), ElementsAre(2, 3, 4)) << mark;
    EXPECT_THAT(taken_out(record_of("degC", {mark, mark, mark})), ElementsAre(0, 1, 2)) << mark;
  }
  EXPECT_THAT(taken_out(record_of("degC", {-273.15, 20.1, 20.4})), ElementsAre(0));
}

TEST(NoReading, MarksOfInstrumentsInDisplacements) {
  for (double mark : {9999.0, -9999.0, 999.9, 32767.0, -3276.8, 65535.0})
    EXPECT_THAT(taken_out(record_of("um", {0.1, 5.2, mark, mark, 8.4})), ElementsAre(2, 3)) << mark;
}

TEST(NoReading, WhatMachinesDoStays) {
  EXPECT_THAT(taken_out(record_of("degC", {20, 90, 160, 240, 320, 320, 320})), IsEmpty()) << "a furnace";
  EXPECT_THAT(taken_out(record_of("degC", {-20, -25, -38, -41, -43, -43, -43})), IsEmpty()) << "a cold night";
  EXPECT_THAT(taken_out(record_of("degC", {20, 20, 60, 60, 20})), IsEmpty()) << "a step within what is usual";
  EXPECT_THAT(taken_out(record_of("um", {0, 0, 500, 500, 0, 0})), IsEmpty()) << "a magnet base that was moved";
  EXPECT_THAT(taken_out(record_of("um", {9900, 9950, 9999, 9999, 10040})), IsEmpty()) << "a far axis that passes 9999";
  EXPECT_THAT(taken_out(record_of("rpm", {0, 0, 9999, 9999, 0})), IsEmpty()) << "a speed";
  EXPECT_THAT(taken_out(record_of("W", {0, 850, 850, 850, 0})), IsEmpty()) << "a heater";
}

}  // namespace
}  // namespace driftwright::no_reading_test
