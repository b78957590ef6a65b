#include "base/record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::record_test {
namespace {

TEST(RecordCsv, ReadsNamesUnitsMinutesAndMissingValues) {
  const Record r =
      read_record_csv(write_file("good.csv", "# a comment\ntime_min,tip_z_um,oil_degC,feed_mm_min\n0,1.5,20,\n2,-3,,600\n"));
  EXPECT_EQ(r.time_s, (std::vector<double>{0, 120}));
  EXPECT_EQ(r.at("tip_z").values, (std::vector<double>{1.5, -3}));
  EXPECT_EQ(r.at("feed").unit, "mm_min");  // longest match: not "feed_mm" in "min"
  EXPECT_TRUE(std::isnan(r.at("oil").values[1]));
  EXPECT_TRUE(std::isnan(r.at("feed").values[0]));
}

TEST(RecordCsv, WritesWhatItReads) {
  Record r{.source = "x", .time_s = {0, 60}, .channels = {{"a", "K", {0.125, NAN}}, {"b", "um", {1e-7, -42}}}};
  const Record back = read_record_csv(write_file("round.csv", record_csv(r, {"made by a test"})));
  EXPECT_EQ(back.time_s, r.time_s);
  EXPECT_EQ(back.at("b").values, r.at("b").values);
  EXPECT_EQ(back.at("a").values[0], 0.125);
  EXPECT_TRUE(std::isnan(back.at("a").values[1]));
}

struct BadCsv {
  const char* text;
  const char* message;
};
class RecordCsvErrors : public ::testing::TestWithParam<BadCsv> {};

TEST_P(RecordCsvErrors, NameWhatIsWrong) {
  const std::string path = write_file("bad.csv", GetParam().text);
  EXPECT_REFUSED(read_record_csv(path), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Each, RecordCsvErrors,
                         ::testing::Values(BadCsv{"time_s,a_K\n0,1\n", "1 rows of data"},
                                           BadCsv{"time_s,a_K\n0,nan\n1,2\n", "bad.csv:2:3: 'nan' is not a finite number"},
                                           BadCsv{"time_s,a_K\n0,1\n0,2\n", "rows must increase in time"},
                                           BadCsv{"time_s,a_furlong\n0,1\n", "names no unit"},
                                           BadCsv{"time_s,a_K\n0,1\n4e9,2\n", "127 years; 100 years are allowed"},
                                           BadCsv{"time_s,a_K,a_K\n0,1,1\n", "appears twice"},
                                           BadCsv{"t,a_K\n0,1\n", "time_s, time_min or time_h"},
                                           BadCsv{"time_s,a_K\n0,1,2\n", "3 cells, but the header has 2"}));

TEST(RecordCsv, IsReadFromAnyEncodingAndWrittenInOne) {
  const Record record = read_record_csv(write_file("latin1.csv", "time_s,t_Geh\xE4use_degC\n0,20\n1,21\n"));
  EXPECT_EQ(record.channels.at(0).name, "t_Geh\xC3\xA4use");
  EXPECT_EQ(read_record_csv(write_file("again.csv", record_csv(record))).channels.at(0).name, "t_Geh\xC3\xA4use");
  const Record surrogate = read_record_csv(write_file("wild.csv", "time_s,t_\xED\xA0\x80_degC\n0,20\n1,21\n"));
  EXPECT_EQ(surrogate.channels.at(0).name, "t_\xC3\xAD\xC2\xA0\xE2\x82\xAC");  // no UTF-8, though it looks so
}

TEST(RecordCsv, CommentsStayComments) {
  const Record record{.source = "x", .time_s = {0.0, 1.0}, .channels = {{"a", "K", {1.0, 2.0}}}};
  const std::string text = record_csv(record, {"of the scenario a\nb.yaml", "c\rd"});
  EXPECT_EQ(text.substr(0, text.find("time_s")), "# of the scenario a b.yaml\n# c d\n");
  EXPECT_EQ(read_record_csv(write_file("commented.csv", text)).n_samples(), 2u);
}

TEST(RecordCsv, RefusesFoldersAndControlCharactersInNames) {
  EXPECT_THROW((void)read_record_csv(temporary_folder().string()), InputError);
  EXPECT_THROW((void)read_record_csv(write_file("bell.csv", "time_s,a\a_K\n0,1\n1,2\n")), InputError);
}

TEST(RecordCsv, RefusesAMissingFile) {
  EXPECT_REFUSED(read_record_csv("/nowhere/x.csv"), "cannot be opened");
}

}  // namespace
}  // namespace driftwright::record_test
