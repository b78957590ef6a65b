// Lines of a stream: CSV as records have it, loggers' columns, JSON.

#include "follow/row_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/config_map.hpp"
#include "base/config_text.hpp"
#include "base/errors.hpp"
#include "scenarios/reader/read_columns.hpp"

namespace driftwright::follow::row_text_test {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::IsNan, ::testing::ThrowsMessage;

ColumnMap map_of(const std::string& yaml) {
  static const schema::Map columns = scenarios::columns_schema();
  return scenarios::read_columns(ConfigMap::of_tree(read_config_text(yaml, "map.yaml")).described_by(columns));
}

TEST(RowText, ReadsRowsAsRecordsHaveThem) {
  RowText text(std::nullopt, "a test");
  EXPECT_FALSE(text.take("# by hand"));
  EXPECT_FALSE(text.take("time_min,speed_rpm,t01_degC\r"));
  ASSERT_EQ(text.channels().size(), 2u);
  EXPECT_EQ(text.channels()[1].header(), "t01_degC");
  const auto row = text.take("2,1500,21.5\r");
  ASSERT_TRUE(row);
  EXPECT_EQ(row->time_s, 120.0);
  EXPECT_THAT(row->values, ElementsAre(1500.0, 21.5));
  EXPECT_THAT(text.take("3,,nan")->values, ElementsAre(IsNan(), IsNan()));
  EXPECT_FALSE(text.take("time_min,speed_rpm,t01_degC"));  // the source begins anew
  const auto broken = text.take("4,15oo,21.5");
  EXPECT_EQ(broken->n_unreadable, 1);
  EXPECT_THAT(broken->values, ElementsAre(IsNan(), 21.5));
}

TEST(RowText, ARowThatIsNoneLeavesTheNextOneWell) {
  RowText text(std::nullopt, "a test");
  EXPECT_FALSE(text.take("time_s,t01_degC"));
  for (const char* line : {"1", "1,2,3", "x,20", ",20", "{\"time_s\":1}", "1,\"20"})
    EXPECT_THROW((void)text.take(line), RangeError) << line;
  EXPECT_TRUE(text.take("2,20"));
}

TEST(RowText, ReadsJsonInAnyOrder) {
  RowText text(std::nullopt, "a test");
  const auto row = text.take(R"({"t01_degC": 21.5, "time_s": 10, "speed_rpm": null})");
  ASSERT_TRUE(row);
  EXPECT_EQ(row->time_s, 10.0);
  EXPECT_THAT(row->values, ElementsAre(21.5, IsNan()));
  EXPECT_THAT(text.take(R"({"speed_rpm": 800, "time_s": 11, "t01_degC": "21.75", "note_degC": 3})")->values,
              ElementsAre(21.75, 800.0));
  EXPECT_THAT(text.take(R"({"time_s": 12})")->values, ElementsAre(IsNan(), IsNan()));
  EXPECT_EQ(text.take(R"({"time_s": 13, "t01_degC": "warm"})")->n_unreadable, 1);
  EXPECT_THROW((void)text.take("{\"time_s\": 14"), RangeError);
  EXPECT_THROW((void)text.take("{}"), RangeError);
}

TEST(RowText, ReadsALoggersColumns) {
  RowText text(map_of("separator: ';'\ndecimal: ','\ntime: {column: Zeit, format: '%d.%m.%Y %H:%M:%S'}\n"
                      "channels:\n  t01: {column: 'T 1 (°C)', unit: degC}\n  speed: {column: n, unit: rpm}\n"),
               "a test");
  EXPECT_FALSE(text.take("Logger 7; serial 12"));
  EXPECT_FALSE(text.take("Zeit;n;T 1 (°C)"));
  EXPECT_EQ(text.take("01.02.2024 07:00:00;1500,5;21,25")->time_s, 0.0);
  const auto row = text.take("01.02.2024 07:01:30;1500,5;21,25");
  EXPECT_EQ(row->time_s, 90.0);
  EXPECT_THAT(row->values, ElementsAre(21.25, ::testing::DoubleNear(1500.5, 1e-9)));
}

TEST(RowText, AHeaderThatNobodyCanReadIsRefused) {
  const auto header = [](const std::string& line) {
    return [line] { (void)RowText(std::nullopt, "the stream").take(line); };
  };
  EXPECT_THAT(header("time_s,t01"), ThrowsMessage<InputError>(HasSubstr("column 't01' has no unit")));
  EXPECT_THAT(header("t01_degC"), ThrowsMessage<InputError>(HasSubstr("no column time_s")));
  EXPECT_THAT(header("time_s,a_degC,a_K"), ThrowsMessage<InputError>(HasSubstr("two columns are called 'a'")));
  EXPECT_THAT(header(R"({"temperature": 3})"), ThrowsMessage<InputError>(HasSubstr("'temperature' has no unit")));
}

}  // namespace
}  // namespace driftwright::follow::row_text_test
